// What draws: a GPU, or the processor in its place.

import * as THREE from "three";

const SOFTWARE = /swiftshader|llvmpipe|software|basic render/i;

/** Null where the browser has no WebGL: panels and d-pad still work. @param {HTMLCanvasElement} canvas */
export function createRenderer(canvas) {
  try {
    const renderer = new THREE.WebGLRenderer({ canvas, antialias: !isSoftwareHere(), powerPreference: "low-power" });
    renderer.outputColorSpace = THREE.SRGBColorSpace;
    return renderer;
  } catch {
    return null;
  }
}

/** Whether the processor draws. @param {THREE.WebGLRenderer | null} renderer */
export function isSoftware(renderer) {
  return renderer !== null && SOFTWARE.test(nameOf(renderer.getContext()));
}

/** Software drawing pays for every sample: asked on a canvas of its own, before the real one is made. */
function isSoftwareHere() {
  const probe = document.createElement("canvas").getContext("webgl2");
  const name = probe === null ? "" : nameOf(probe);
  probe?.getExtension("WEBGL_lose_context")?.loseContext();
  return SOFTWARE.test(name);
}

/** @param {WebGLRenderingContext | WebGL2RenderingContext} gl */
function nameOf(gl) {
  const info = gl.getExtension("WEBGL_debug_renderer_info");
  return info === null ? "" : String(gl.getParameter(info.UNMASKED_RENDERER_WEBGL));
}
