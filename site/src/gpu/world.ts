import { type GpuErrorCode, openDevice, PairFinder, type StageTime, SUMMARY_BYTES, SUMMARY_DISPATCH } from "sweep-and-prune-gpu";
import { bodiesOf, WIDTH } from "./bodies.ts";
import { compile, type Pipelines } from "./pipelines.ts";

/** The size of a picture in pixels, and its colors: red, green, blue and opacity, from 0 to 1. */
export interface Look {
  readonly width: number;
  readonly height: number;
  readonly box: readonly number[];
  readonly highlighted: readonly number[];
  readonly ground: readonly number[];
}

/** What a search reports. */
export interface Found {
  readonly boxes: number;
  readonly pairs: number;
  /** How many boxes are in a pair. */
  readonly overlapping: number;
  /** None if the browser gives none. */
  readonly times: readonly StageTime[];
}

/** The boxes, and for each whether it is highlighted: 1 or 0. */
export interface Copied {
  readonly dimensions: 2 | 3;
  readonly pairs: number;
  readonly rows: ArrayBuffer;
  readonly highlighted: ArrayBuffer;
}

/** Buffers by their binding. */
type Bound = Readonly<Record<number, GPUBuffer>>;

/** How many pairs there is space for at first. */
const FIRST_CAPACITY = 256;

/** What buffers and textures may be used for, as WebGPU numbers it. */
const Usage = { MAP_READ: 1, COPY_SRC: 4, COPY_DST: 8, ATTACHMENT: 0x10, VERTEX: 0x20, UNIFORM: 0x40, STORAGE: 0x80, INDIRECT: 0x100 } as const;

/** Moving boxes and their pairs, on a device of their own. What it does is done one after the other. */
export class World {
  /** Why the device can do no more. */
  readonly failed: Promise<GpuErrorCode>;
  readonly #pipelines: Pipelines;
  readonly #bodies: GPUBuffer;
  readonly #boxes: GPUBuffer;
  readonly #summary: GPUBuffer;
  /** For each box whether it is highlighted, and behind the last how many these are. */
  readonly #highlighted: GPUBuffer;
  readonly #look: GPUBuffer;
  #pairs: GPUBuffer;
  #found = 0;
  #last: Promise<unknown> = Promise.resolve();

  static async open(canvas: HTMLCanvasElement, count: number, dimensions: 2 | 3): Promise<World> {
    const device = await openDevice();
    try {
      return new World(device, await PairFinder.create(device, { dimensions, timed: true }), canvas, count, dimensions);
    } catch (error) {
      device.destroy();
      throw error;
    }
  }

  private constructor(
    private readonly device: GPUDevice,
    private readonly finder: PairFinder,
    private readonly canvas: HTMLCanvasElement,
    private readonly count: number,
    private readonly dimensions: 2 | 3,
  ) {
    this.failed = new Promise((resolve) => {
      void device.lost.then(() => resolve("DEVICE_LOST"));
      device.addEventListener("uncapturederror", ({ error }) => resolve(error instanceof GPUOutOfMemoryError ? "OUT_OF_MEMORY" : "DEVICE"));
    });
    const format = navigator.gpu.getPreferredCanvasFormat();
    this.#context.configure({ device, format });
    this.#pipelines = compile(device, format, dimensions);
    const bodies = bodiesOf(count, dimensions);
    this.#bodies = this.#buffer(bodies.byteLength, Usage.STORAGE | Usage.COPY_DST);
    this.#boxes = this.#buffer(8 * dimensions * count, Usage.STORAGE | Usage.VERTEX | Usage.COPY_SRC);
    this.#summary = this.#buffer(SUMMARY_BYTES, Usage.STORAGE | Usage.INDIRECT | Usage.COPY_SRC);
    this.#highlighted = this.#buffer(4 * (count + 1), Usage.STORAGE | Usage.VERTEX | Usage.COPY_SRC | Usage.COPY_DST);
    this.#look = this.#buffer(64, Usage.UNIFORM | Usage.COPY_DST);
    this.#pairs = this.#buffer(8 * FIRST_CAPACITY, Usage.STORAGE);
    device.queue.writeBuffer(this.#bodies, 0, bodies);
    this.#step();
  }

  /** Gives all memory of the device back. */
  destroy(): void {
    this.device.destroy();
  }

  /** Moves the boxes if `isStep`, finds their pairs and draws them. Ends when the device is done. */
  frame(isStep: boolean, look: Look): Promise<Found> {
    return this.#inTurn(async () => {
      if (isStep) this.#step();
      for (;;) {
        await this.finder.findInto({ boxes: this.#boxes, count: this.count }, this.#pairs, this.#summary);
        this.#highlight();
        this.#draw(look);
        const [{ found, written }, overlapping, times] = await Promise.all([this.finder.readSummary(this.#summary), this.#copy(this.#highlighted, 4 * this.count), this.finder.stageTimes()]);
        this.#found = found;
        if (written === found) return { boxes: this.count, pairs: found, overlapping: new Uint32Array(overlapping)[0]!, times };
        this.#pairs.destroy();
        // A quarter more, since the number varies from step to step.
        this.#pairs = this.#buffer(8 * Math.ceil(1.25 * found), Usage.STORAGE);
      }
    });
  }

  /** Copies what the last frame shows. */
  copy(): Promise<Copied> {
    return this.#inTurn(async () => {
      const [rows, highlighted] = await Promise.all([this.#copy(this.#boxes), this.#copy(this.#highlighted)]);
      return { dimensions: this.dimensions, pairs: this.#found, rows, highlighted };
    });
  }

  #step(): void {
    const buffers = { 0: this.#bodies, 1: this.#boxes };
    this.#compute(this.#pipelines.step, buffers, (pass) => pass.dispatchWorkgroups(Math.ceil(this.count / 256)));
  }

  #highlight(): void {
    const buffers = { 2: this.#pairs, 3: this.#summary, 4: this.#highlighted };
    this.#submit((encoder) => encoder.clearBuffer(this.#highlighted));
    this.#compute(this.#pipelines.highlight, buffers, (pass) => pass.dispatchWorkgroupsIndirect(this.#summary, SUMMARY_DISPATCH));
  }

  #compute(pipeline: GPUComputePipeline, buffers: Bound, dispatch: (pass: GPUComputePassEncoder) => void): void {
    this.#submit((encoder) => {
      const pass = encoder.beginComputePass();
      pass.setPipeline(pipeline);
      pass.setBindGroup(0, this.#bind(pipeline, buffers));
      dispatch(pass);
      pass.end();
    });
  }

  #draw({ width, height, box, highlighted, ground }: Look): void {
    const { picture } = this.#pipelines;
    if (this.canvas.width !== width) this.canvas.width = width;
    if (this.canvas.height !== height) this.canvas.height = height;
    const depth = this.device.createTexture({ size: [width, height], format: "depth24plus", usage: Usage.ATTACHMENT });
    this.device.queue.writeBuffer(this.#look, 0, Float32Array.of(...box, ...highlighted, ...ground, WIDTH / width, 1 / height));
    this.#submit((encoder) => {
      const pass = encoder.beginRenderPass({
        colorAttachments: [{ view: this.#context.getCurrentTexture().createView(), clearValue: [...ground], loadOp: "clear", storeOp: "store" }],
        depthStencilAttachment: { view: depth.createView(), depthClearValue: 1, depthLoadOp: "clear", depthStoreOp: "discard" },
      });
      pass.setPipeline(picture);
      pass.setBindGroup(0, this.#bind(picture, { 5: this.#look }));
      pass.setVertexBuffer(0, this.#boxes);
      pass.setVertexBuffer(1, this.#highlighted);
      pass.draw(4, this.count);
      pass.end();
    });
    depth.destroy();
  }

  get #context(): GPUCanvasContext {
    return this.canvas.getContext("webgpu") as GPUCanvasContext;
  }

  #buffer(size: number, usage: number): GPUBuffer {
    return this.device.createBuffer({ size, usage });
  }

  #bind(pipeline: GPUComputePipeline | GPURenderPipeline, buffers: Bound): GPUBindGroup {
    const entries = Object.entries(buffers).map(([binding, buffer]) => ({ binding: Number(binding), resource: { buffer } }));
    return this.device.createBindGroup({ layout: pipeline.getBindGroupLayout(0), entries });
  }

  #submit(encode: (encoder: GPUCommandEncoder) => void): void {
    const encoder = this.device.createCommandEncoder();
    encode(encoder);
    this.device.queue.submit([encoder.finish()]);
  }

  /** Copies what a buffer has from an offset on. */
  async #copy(buffer: GPUBuffer, offset = 0): Promise<ArrayBuffer> {
    const copy = this.#buffer(buffer.size - offset, Usage.MAP_READ | Usage.COPY_DST);
    this.#submit((encoder) => encoder.copyBufferToBuffer(buffer, offset, copy, 0, copy.size));
    await copy.mapAsync(Usage.MAP_READ);
    const bytes = copy.getMappedRange().slice(0);
    copy.destroy();
    return bytes;
  }

  #inTurn<R>(run: () => Promise<R>): Promise<R> {
    const result = this.#last.then(run);
    this.#last = result.catch(() => {});
    return result;
  }
}
