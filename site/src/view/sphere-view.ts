import {
  BoxGeometry,
  Color,
  DynamicDrawUsage,
  EdgesGeometry,
  InstancedBufferAttribute,
  InstancedBufferGeometry,
  LineBasicMaterial,
  LineSegments,
  Mesh,
  MeshBasicMaterial,
  PerspectiveCamera,
  PlaneGeometry,
  Scene,
  ShaderMaterial,
  Spherical,
  Vector3,
  WebGLRenderer,
} from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import { arrowOf } from "../panel/arrows.ts";
import { pixelRatio } from "../plot/line-plot.ts";
import type { Theme } from "./theme.ts";
import { type Picture, shownHeight, type View, type World } from "./view.ts";

/** Where the eye is at first, seen from the middle of the world. */
const DIRECTION = new Vector3(0.5, 0.36, 1).normalize();
/** Where the light comes from. */
const LIGHT = new Vector3(0.45, 1, 0.55).normalize();

/**
 * Spheres in a box, all in one draw call. Each instance is a square that faces the eye, shaded as
 * the half of a sphere that can be seen: perfectly round, two triangles a body, and what is sent
 * to the graphics processor for a picture is just the array of positions.
 */
export class SphereView implements View {
  readonly #renderer: WebGLRenderer;
  readonly #scene = new Scene();
  readonly #camera = new PerspectiveCamera(32, 4 / 3, 0.01, 1000);
  readonly #controls: OrbitControls;
  readonly #spheres: Mesh<InstancedBufferGeometry, ShaderMaterial>;
  readonly #floor = new Mesh(new PlaneGeometry(1, 1).rotateX(-Math.PI / 2), new MeshBasicMaterial());
  readonly #edges = new LineSegments(new EdgesGeometry(new BoxGeometry(1, 1, 1)), new LineBasicMaterial());
  #framed = false;
  /** The part of the world that is shown: its middle and its sides. */
  readonly #middle = new Vector3();
  readonly #sides = new Vector3(1, 1, 1);

  /**
   * `surface` takes the pointer and the keys that turn the view; `changed` is called when it has
   * turned and must be drawn again. `signal` ends it.
   */
  constructor(canvas: HTMLCanvasElement, surface: HTMLElement, theme: Theme, private readonly changed: () => void, signal: AbortSignal) {
    try {
      this.#renderer = new WebGLRenderer({ canvas, antialias: true, alpha: true });
    } catch (error) {
      throw new Error("drawing the spheres needs WebGL, which this browser does not offer. The boxes are searched anyway, and the numbers are correct", { cause: error });
    }
    this.#spheres = new Mesh(squares(0), sphereMaterial());
    this.#spheres.frustumCulled = false;
    this.#scene.add(this.#floor, this.#edges, this.#spheres);
    this.setTheme(theme);

    this.#controls = new OrbitControls(this.#camera, surface);
    this.#controls.enablePan = false;
    this.#controls.maxPolarAngle = 0.5 * Math.PI;
    surface.style.touchAction = "pan-y";
    // The wheel scrolls the page until the stage has been chosen by a click or by the keyboard.
    this.#controls.enableZoom = false;
    surface.addEventListener("focus", () => (this.#controls.enableZoom = true), { signal });
    surface.addEventListener("blur", () => (this.#controls.enableZoom = false), { signal });
    surface.addEventListener("keydown", (event) => this.#turnByKey(event), { signal });
    this.#controls.addEventListener("change", changed);
    signal.addEventListener("abort", () => {
      this.#controls.dispose();
      this.#renderer.dispose();
      this.#renderer.forceContextLoss(); // a browser has few contexts, and frees one late
      surface.style.touchAction = "";
    });
  }

  begin(world: World, radii: Float32Array, tints: Float32Array): void {
    const [left = 0, bottom = 0, back = 0] = world.min;
    const [right = 1, , front = 1] = world.max;
    this.#sides.set(right - left, shownHeight(world, radii), front - back);
    this.#middle.set(left, bottom, back).addScaledVector(this.#sides, 0.5);
    this.#edges.scale.copy(this.#sides);
    this.#edges.position.copy(this.#middle);
    this.#floor.scale.set(this.#sides.x, 1, this.#sides.z);
    this.#floor.position.set(this.#middle.x, bottom, this.#middle.z);

    const geometry = squares(radii.length);
    geometry.setAttribute("radius", new InstancedBufferAttribute(radii, 1));
    geometry.setAttribute("tint", new InstancedBufferAttribute(tints, 1));
    this.#spheres.geometry.dispose();
    this.#spheres.geometry = geometry;
    this.#frame();
  }

  setTheme(theme: Theme): void {
    this.#spheres.material.uniforms["ramp"] = { value: theme.ramp.map((color) => new Color(color)) };
    this.#floor.material.color.set(theme.floor);
    this.#edges.material.color.set(theme.edge);
  }

  resize(width: number, height: number): void {
    this.#renderer.setPixelRatio(pixelRatio());
    this.#renderer.setSize(width, height, false);
    this.#camera.aspect = width / height;
    this.#camera.updateProjectionMatrix();
    this.#frame();
  }

  draw({ positions }: Picture): void {
    const centers = this.#spheres.geometry.getAttribute("center") as InstancedBufferAttribute;
    if (centers.array.length === positions.length) {
      centers.array.set(positions);
      centers.needsUpdate = true;
    }
    this.#renderer.render(this.#scene, this.#camera);
  }

  /** Moves the camera along its direction until the world fits the view. */
  #frame(): void {
    const { position, fov, aspect } = this.#camera;
    const target = this.#controls.target;
    const back = this.#framed ? position.clone().sub(target).normalize() : DIRECTION.clone();
    this.#framed = true;
    target.copy(this.#middle);
    const right = new Vector3(0, 1, 0).cross(back).normalize();
    const up = back.clone().cross(right);
    const slopeUp = Math.tan((fov * Math.PI) / 360);
    let distance = 0;
    for (let corner = 0; corner < 8; corner++) {
      const sign = (bit: number): number => (corner & bit ? 0.53 : -0.53);
      const at = new Vector3(sign(1), sign(2), sign(4)).multiply(this.#sides);
      const needed = Math.max(Math.abs(at.dot(up)) / slopeUp, Math.abs(at.dot(right)) / (slopeUp * aspect));
      distance = Math.max(distance, at.dot(back) + needed);
    }
    this.#controls.minDistance = 0.2 * distance;
    this.#controls.maxDistance = 2 * distance;
    position.copy(target).addScaledVector(back, distance);
    this.#camera.near = distance / 50;
    this.#camera.far = distance * 5;
    this.#camera.updateProjectionMatrix();
    this.#controls.update();
  }

  #turnByKey(event: KeyboardEvent): void {
    const { target } = this.#controls;
    const eye = new Spherical().setFromVector3(this.#camera.position.clone().sub(target));
    const arrow = arrowOf(event);
    if (arrow) [eye.theta, eye.phi] = [eye.theta + 0.1 * arrow[0], eye.phi + 0.1 * arrow[1]];
    else if (event.key === "+" || event.key === "=") eye.radius *= 0.9;
    else if (event.key === "-") eye.radius /= 0.9;
    else return;
    event.preventDefault();
    eye.phi = Math.min(Math.max(eye.phi, 0.05), 0.5 * Math.PI);
    this.#camera.position.setFromSpherical(eye).add(target);
    this.#controls.update();
    this.changed();
  }
}

/** A square for each body, from (-1, -1) to (1, 1). */
function squares(bodies: number): InstancedBufferGeometry {
  const geometry = new InstancedBufferGeometry().copy(new PlaneGeometry(2, 2) as unknown as InstancedBufferGeometry);
  const centers = new InstancedBufferAttribute(new Float32Array(3 * bodies), 3).setUsage(DynamicDrawUsage);
  geometry.setAttribute("center", centers);
  geometry.instanceCount = bodies;
  return geometry;
}

function sphereMaterial(): ShaderMaterial {
  return new ShaderMaterial({
    uniforms: { ramp: { value: [] }, light: { value: LIGHT } },
    // Edges are smoothed by how many samples of a pixel they cover.
    alphaToCoverage: true,
    vertexShader: `
      attribute vec3 center;
      attribute float radius;
      attribute float tint;
      uniform vec3 ramp[5];
      varying vec2 corner;
      varying vec3 bodyColor;

      void main() {
        corner = position.xy;
        float at = clamp(tint, 0.0, 0.9999) * 4.0;
        int below = int(at);
        bodyColor = mix(ramp[below], ramp[below + 1], fract(at));
        vec4 middle = modelViewMatrix * vec4(center, 1.0);
        gl_Position = projectionMatrix * (middle + vec4(radius * corner, 0.0, 0.0));
      }`,
    fragmentShader: `
      uniform vec3 light;
      varying vec2 corner;
      varying vec3 bodyColor;

      void main() {
        float outward = length(corner);
        float coverage = clamp((1.0 - outward) / fwidth(outward) + 0.5, 0.0, 1.0);
        if (coverage == 0.0) discard;
        vec3 normal = vec3(corner, sqrt(max(1.0 - outward * outward, 0.0)));
        float sun = max(dot(normal, (viewMatrix * vec4(light, 0.0)).xyz), 0.0);
        float sky = 0.5 + 0.5 * dot(normal, (viewMatrix * vec4(0.0, 1.0, 0.0, 0.0)).xyz);
        float rim = mix(0.7, 1.0, smoothstep(0.0, 0.5, normal.z));
        gl_FragColor = vec4(bodyColor * rim * (0.16 + 0.42 * sky + 0.62 * sun), coverage);
        #include <colorspace_fragment>
      }`,
  });
}
