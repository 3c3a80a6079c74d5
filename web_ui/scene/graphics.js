// Creates the renderer: on a GPU, or in software.

import * as THREE from "three";

import "./colors.js";

const SOFTWARE = /swiftshader|llvmpipe|software|basic render/i;

/** Null if the browser has no WebGL: panels and buttons still work. @param {HTMLCanvasElement} canvas */
export function createRenderer(canvas) {
  try {
    const renderer = new THREE.WebGLRenderer({ canvas, antialias: !isSoftwareHere(), powerPreference: "low-power" });
    renderer.outputColorSpace = THREE.LinearSRGBColorSpace; // colors are display values already (colors.js)
    return renderer;
  } catch {
    return null;
  }
}

/** Whether rendering is done in software. @param {THREE.WebGLRenderer | null} renderer */
export function isSoftware(renderer) {
  return renderer !== null && SOFTWARE.test(nameOf(renderer.getContext()));
}

/** Software rendering pays for every sample, so this is tested on a separate canvas before the real one is created. */
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
