// A soft spot under the robot in place of a shadow: it costs nothing and shows where the robot stands.

import * as THREE from "three";

export function createBlob() {
  const size = 48;
  const data = new Uint8Array(size * size * 4);
  for (let row = 0; row < size; row++) {
    for (let column = 0; column < size; column++) {
      const distance = Math.hypot(row - size / 2 + 0.5, column - size / 2 + 0.5) / (size / 2);
      data[(row * size + column) * 4 + 3] = 150 * Math.min(1, Math.max(0, 1 - distance) * 1.8) ** 1.5;
    }
  }
  const texture = new THREE.DataTexture(data, size, size);
  texture.magFilter = THREE.LinearFilter;
  texture.needsUpdate = true;
  const geometry = new THREE.PlaneGeometry(0.17, 0.17);
  const material = new THREE.MeshBasicMaterial({ map: texture, transparent: true, depthWrite: false });
  const group = new THREE.Mesh(geometry, material);
  group.position.set(0.022, 0, 0.0006);
  group.renderOrder = 1;
  return { group, update() {}, dispose: () => [texture, geometry, material].forEach((thing) => thing.dispose()) };
}
