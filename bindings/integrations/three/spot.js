// A laser spot with its speckle on meshes of three.js: the function files of tem00 in a node of its
// materials.
import * as THREE from 'three/webgpu';
import { normalWorld, positionWorld, storage, uniform, vec3, wgsl, wgslFn } from 'three/tsl';
import init, { SpotSpeckle, functions } from './tem00_web.js';

const PIXELS = 512;

await init();
// A spot 6 cm wide, and a lens that makes speckle of 3 pixels. All lengths are in metres.
const tem00 = new SpotSpeckle(
  [650e-9, 5e-3, 0.03], [0, 0.1, 0.3], [0, 0, 0],
  [25e-3, 80, 20, PIXELS], [0, 0, 0.3], [0, 0, 0], 1,
);
const light = tem00.light();
const { size } = tem00;

// What the functions read: three.js declares the buffers under these names. A part that moves has a
// frame of its own.
const buffer = (name, values, width) =>
  storage(new THREE.StorageBufferAttribute(values, width), `vec${width}`, values.length / width)
    .setName(name)
    .toReadOnly();
const buffers = [
  buffer('coefficients', tem00.coefficients(), 2),
  buffer('laws', tem00.laws(), 4),
  buffer('frame', tem00.frame([0, 0, 0]), 4),
];
const row = (i, n = 4) => Array.from(light.slice(4 * i, 4 * i + n)).join(', ');
// Rows of a vector and a number, but for two quaternions and the last two.
const members = [...'vvvvqvqvvvvvpq'].map((kind, i) => {
  const at = `frame.value[${i}]`;
  return { v: `${at}.xyz, ${at}.w`, p: `${at}.xy, ${at}.zw`, q: at }[kind];
});
const code = wgsl(`${functions()}
fn tem00_stack_coefficient(slice: u32, cell: vec2<u32>) -> vec2<f32> {
    return coefficients.value[(slice * ${size}u + cell.y) * ${size}u + cell.x];
}
fn tem00_stack_law(slice: u32, row: u32) -> vec4<f32> { return laws.value[14u * slice + row]; }
fn spot_() -> Tem00SpotLight {
    return Tem00SpotLight(
        vec3<f32>(${row(0, 3)}), ${light[3]}, vec3<f32>(${row(1, 3)}), ${light[7]},
        vec3<f32>(${row(2, 3)}), 0.0, vec3<f32>(${row(3, 3)}), 0.0,
        Tem00Axis(${row(4)}), Tem00Axis(${row(5)}));
}
fn frame_() -> Tem00SpeckleFrame { return Tem00SpeckleFrame(${members.join(', ')}); }`);
const shade = wgslFn(`
fn shade(p: vec3<f32>, n: vec3<f32>, speckle: f32, a: vec2<f32>, b: vec4<f32>, c: vec4<f32>) -> vec3<f32> {
    let event = tem00_spot_next_event(spot_(), p);
    let factor = select(1.0, tem00_factor(frame_(), p, n), speckle > 0.5);
    return vec3<f32>(0.8 * 0.318309886 * event.e_perp * max(dot(n, event.wi), 0.0) * factor);
}`, [code]);

const speckle = uniform(1);
const material = new THREE.MeshBasicNodeMaterial();
// The elements are there so that the buffers are bound.
const elements = buffers.map((buffer) => buffer.element(0));
material.colorNode = shade(positionWorld, normalWorld, speckle, ...elements);
const scene = new THREE.Scene();
scene.add(new THREE.Mesh(new THREE.TorusKnotGeometry(0.02, 0.005, 256, 64), material));
const wall = new THREE.Mesh(new THREE.PlaneGeometry(0.2, 0.2), material);
wall.position.z = -0.03;
scene.add(wall);
const camera = new THREE.PerspectiveCamera(20, 1, 0.01, 1);
camera.position.z = 0.3;

const renderer = new THREE.WebGPURenderer();
await renderer.init();
renderer.setSize(PIXELS, PIXELS);
document.body.append(renderer.domElement);

/** The red of all pixels, in W/(m² sr). */
async function radiance(on) {
  speckle.value = on;
  const target = new THREE.RenderTarget(PIXELS, PIXELS, { type: THREE.FloatType });
  renderer.setRenderTarget(target);
  renderer.render(scene, camera);
  const pixels = await renderer.readRenderTargetPixelsAsync(target, 0, 0, PIXELS, PIXELS);
  renderer.setRenderTarget(null);
  return Array.from({ length: PIXELS * PIXELS }, (_, i) => pixels[4 * i]);
}
const [smooth, rough] = [await radiance(0), await radiance(1)];
const brightest = smooth.reduce((a, b) => Math.max(a, b), 0);
const factors = rough
  .map((light, i) => light / smooth[i])
  .filter((_, i) => smooth[i] > 0.1 * brightest);
const mean = factors.reduce((a, b) => a + b) / factors.length;
const variance = factors.reduce((a, b) => a + (b - mean) ** 2, 0) / factors.length;
const contrast = Math.sqrt(variance) / mean;
const middle = smooth[PIXELS * (PIXELS + 1) / 2];
window.numbers = { middle, mean, contrast, pixels: factors.length };
document.getElementById('numbers').textContent =
  `contrast ${contrast.toFixed(3)} on ${factors.length} pixels, mean ${mean.toFixed(3)}`;

material.colorNode = material.colorNode.mul(vec3(0.8, 0.03, 0.03)); // the light is red
material.needsUpdate = true;
renderer.render(scene, camera);
document.body.dataset.done = '';
