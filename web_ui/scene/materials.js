// The materials of the scene. Light is computed for each corner, not for each pixel: in software rendering a pixel then
// costs one color. Values are in display space (colors.js).

import * as THREE from "three";

import { PAPER, TAPE } from "./colors.js";
import { LIGHT } from "./lights.js";

/** Start of every vertex shader: position and normal in the world. */
const PLACED = /* glsl */ `
  vec4 place = vec4(position, 1.0);
  vec3 facing = normal;
  #ifdef USE_INSTANCING
    place = instanceMatrix * place;
    facing = mat3(instanceMatrix) * facing;
  #endif
  facing = normalize(mat3(modelMatrix) * facing);
  gl_Position = projectionMatrix * modelViewMatrix * place;
`;
const LIGHTING = /* glsl */ `
  uniform vec3 uSun, uSky, uGround, uKey, uDim;
  vec3 lightOn(vec3 facing) {
    return mix(uGround, uSky, facing.z * 0.5 + 0.5) + uKey * max(dot(facing, uSun), 0.0);
  }
`;

const LIT_VERTEX = /* glsl */ `
  ${LIGHTING}
  uniform vec3 uColor;
  varying vec3 vColor;
  #ifdef ZIGZAG
    attribute vec2 aEdge;
    varying vec2 vEdge;
  #endif
  #ifdef MAP
    varying vec2 vUv;
  #endif
  void main() {
    ${PLACED}
    vColor = uColor * uDim;
    #ifndef FLAT
      vColor *= lightOn(facing);
    #endif
    #ifdef USE_COLOR
      vColor *= color;
    #endif
    #ifdef USE_INSTANCING_COLOR
      vColor *= instanceColor;
    #endif
    #ifdef ZIGZAG
      vEdge = aEdge;
    #endif
    #ifdef MAP
      vUv = uv;
    #endif
  }
`;
const LIT_FRAGMENT = /* glsl */ `
  uniform float uOpacity;
  varying vec3 vColor;
  #ifdef ZIGZAG
    varying vec2 vEdge;
  #endif
  #ifdef MAP
    uniform sampler2D uMap;
    varying vec2 vUv;
  #endif
  #ifdef PRINT
    uniform vec3 uTape, uPaper;
  #endif
  void main() {
    vec4 shown = vec4(vColor, uOpacity);
    #ifdef MAP
      vec4 texel = texture2D(uMap, vUv);
      #ifdef PRINT
        texel.rgb = mix(uTape, uPaper, texel.rgb);
      #endif
      shown *= texel;
    #endif
    #ifdef ZIGZAG
      if (vEdge.y < 5.0) {
        float pixel = fwidth(vEdge.x);
        float wave = abs(fract(vEdge.x) * 2.0 - 1.0) * 0.56 - 0.28;
        float line = 1.0 - smoothstep(0.1, 0.2, abs(vEdge.y - wave));
        float sheet = smoothstep(0.36, 0.42, abs(vEdge.y));
        float drawn = mix(max(line, sheet), 0.45, smoothstep(0.15, 0.4, pixel));
        shown.rgb *= mix(0.78, 1.06, drawn);
      }
    #endif
    gl_FragColor = shown;
  }
`;

/** What lies on the ground may be translucent, but is drawn in its turn, before all other translucent things. */
const COVERING = /** @type {const} */ ({
  blending: THREE.CustomBlending,
  blendSrc: THREE.SrcAlphaFactor,
  blendDst: THREE.OneMinusSrcAlphaFactor,
});

/**
 * A lit surface.
 *
 * @param {object} [how]
 * @param {THREE.Color} [how.color]
 * @param {boolean} [how.vertexColors]
 * @param {THREE.Texture | null} [how.map]
 * @param {boolean} [how.flat]     the color as given, without shading: floors and paint
 * @param {boolean} [how.print]    the map holds declared colors of the ground
 * @param {boolean} [how.zigzag]   top faces have an attribute `aEdge`: the cut edge of cardboard
 * @param {number} [how.opacity]
 * @param {THREE.Side} [how.side]
 */
export function litMaterial({
  color = new THREE.Color(0xffffff),
  vertexColors = false,
  map = null,
  flat = false,
  print = false,
  zigzag = false,
  opacity = 1,
  side = THREE.FrontSide,
} = {}) {
  /** @type {Record<string, string>} */ const defines = {};
  if (map !== null) defines.MAP = "";
  if (flat) defines.FLAT = "";
  if (print) defines.PRINT = "";
  if (zigzag) defines.ZIGZAG = "";
  return new THREE.ShaderMaterial({
    defines,
    uniforms: {
      ...LIGHT,
      uColor: { value: color },
      uOpacity: { value: opacity },
      uMap: { value: map },
      uTape: { value: TAPE },
      uPaper: { value: PAPER },
    },
    vertexShader: LIT_VERTEX,
    fragmentShader: LIT_FRAGMENT,
    vertexColors,
    side,
    transparent: opacity < 1 && !flat,
    ...(flat && (print || opacity < 1) ? COVERING : {}),
  });
}

/**
 * The robot: lit, with light through its plastic and with lamps. The colors of the lights of robot i are row i of
 * `lamps`: rgb and level; column 0 shines through the plastic (`aGlow` is the share; above one half the whole body
 * flashes), `aLamp` is the column of a lamp.
 *
 * @param {THREE.DataTexture} lamps
 */
export function robotMaterial(lamps) {
  return new THREE.ShaderMaterial({
    uniforms: { ...LIGHT, uLampColors: { value: lamps } },
    vertexColors: true,
    vertexShader: /* glsl */ `
      ${LIGHTING}
      uniform float uLamps;
      uniform sampler2D uLampColors;
      attribute float aGlow;
      attribute float aLamp;
      varying vec3 vColor;
      void main() {
        ${PLACED}
        vec4 lamp = texelFetch(uLampColors, ivec2(int(aLamp + 0.5), gl_InstanceID), 0);
        vec3 own = color * lightOn(facing) * uDim;
        float through = aGlow * min(1.0, 2.0 * lamp.a) + 0.7 * max(0.0, 2.0 * lamp.a - 1.0);
        float share = aLamp > 0.5 ? lamp.a : through;
        float kept = aLamp > 0.5 ? 1.0 - share : 1.0 - 0.9 * share;
        vColor = own * kept + lamp.rgb * share * uLamps * (aLamp > 0.5 ? 1.0 : 0.86);
      }
    `,
    fragmentShader: /* glsl */ `
      varying vec3 vColor;
      void main() { gl_FragColor = vec4(vColor, 1.0); }
    `,
  });
}

/** The dark line around the robot: its hull, a little larger, seen from inside. @param {number} width  meters */
export function outlineMaterial(width) {
  return new THREE.ShaderMaterial({
    uniforms: { ...LIGHT, uWidth: { value: width }, uColor: { value: new THREE.Color(0x5b5046) } },
    vertexShader: /* glsl */ `
      uniform float uWidth;
      uniform vec3 uColor, uDim;
      varying vec3 vColor;
      void main() {
        vColor = uColor * uDim;
        gl_Position = projectionMatrix * modelViewMatrix * instanceMatrix * vec4(position + normal * uWidth, 1.0);
      }
    `,
    fragmentShader: /* glsl */ `
      varying vec3 vColor;
      void main() { gl_FragColor = vec4(vColor, 0.55); }
    `,
    side: THREE.BackSide,
    transparent: true,
    depthWrite: false,
  });
}

/**
 * A translucent overlay. The tint of a copy is its color times its opacity, so no other attribute is needed.
 *
 * @param {object} how
 * @param {THREE.Texture | null} [how.map]   its red channel is the opacity
 * @param {boolean} [how.vertexColors]       the red channel of a corner is the opacity
 * @param {boolean} [how.shines]             light: brighter in the evening
 * @param {THREE.Color | null} [how.color]   of all copies; then the red channel of the tint is the opacity
 */
export function overlayMaterial({ map = null, vertexColors = false, shines = false, color = null }) {
  /** @type {Record<string, string>} */ const defines = {};
  if (map !== null) defines.MAP = "";
  if (color !== null) defines.ONE_COLOR = "";
  if (shines) defines.SHINES = "";
  return new THREE.ShaderMaterial({
    defines,
    uniforms: { ...LIGHT, uMap: { value: map }, uColor: { value: color ?? new THREE.Color(0xffffff) } },
    vertexColors,
    vertexShader: /* glsl */ `
      uniform vec3 uColor, uDim;
      uniform float uLamps;
      varying vec4 vShown;
      varying vec2 vUv;
      void main() {
        vec4 place = vec4(position, 1.0);
        vec3 tint = vec3(1.0);
        #ifdef USE_INSTANCING
          place = instanceMatrix * place;
        #endif
        #ifdef USE_INSTANCING_COLOR
          tint = instanceColor;
        #endif
        gl_Position = projectionMatrix * modelViewMatrix * place;
        #ifdef ONE_COLOR
          vShown = vec4(uColor * tint.r, tint.r);
        #else
          vShown = vec4(tint, max(tint.r, max(tint.g, tint.b)));
        #endif
        #ifdef SHINES
          vShown.rgb *= uLamps;
        #else
          vShown.rgb *= uDim;
        #endif
        #ifdef USE_COLOR
          vShown *= color.r;
        #endif
        vUv = uv;
      }
    `,
    fragmentShader: /* glsl */ `
      uniform sampler2D uMap;
      varying vec4 vShown;
      varying vec2 vUv;
      void main() {
        #ifdef MAP
          gl_FragColor = vShown * texture2D(uMap, vUv).r;
        #else
          gl_FragColor = vShown;
        #endif
      }
    `,
    side: THREE.DoubleSide,
    forceSinglePass: true,
    transparent: true,
    depthWrite: false,
    blending: THREE.CustomBlending,
    blendEquation: THREE.AddEquation,
    blendSrc: THREE.OneFactor,
    blendDst: THREE.OneMinusSrcAlphaFactor,
  });
}
