import type { Kernel, Kernels } from "./kernels.js";
import type { Stage, StageTimer } from "./stages.js";
import { Usage } from "./usage.js";

/** Threads of a workgroup, as in `wgsl/common.wgsl`. */
export const THREADS = 64;

/** The most workgroups in one dimension that every device grants. */
const MOST_GROUPS = 65_535;

/** The distance of the parameters of two steps in their buffer, in bytes: a multiple of every device's alignment. */
const SLOT = 256;

/** The size of the largest parameters, those of `wgsl/search.wgsl`, in bytes. */
const PARAMS = 96;

/** A buffer as a kernel sees it: its first bytes. */
export interface Bound {
  readonly buffer: GPUBuffer;
  readonly size: number;
}

/** One dispatch. */
interface Step {
  readonly stage: Stage;
  readonly kernel: Kernel;
  readonly params: readonly number[];
  readonly buffers: readonly Bound[];
  readonly groups: number;
}

/** Dispatches in the order in which they run. Each sees what those before it wrote. */
export class Steps {
  readonly #steps: Step[] = [];
  /** The stage of the steps that are added. */
  stage: Stage = "read boxes";

  /**
   * Adds a dispatch of this many workgroups. `params` are the fields of the kernel's `Params`, and `buffers` its bindings
   * from 1 on.
   */
  add(kernel: Kernel, params: readonly number[], buffers: readonly Bound[], groups: number): void {
    this.#steps.push({ stage: this.stage, kernel, params, buffers, groups });
  }

  /** Adds a dispatch of one thread for each of `count` items. */
  forEach(kernel: Kernel, count: number, params: readonly number[], buffers: readonly Bound[]): void {
    this.add(kernel, params, buffers, Math.ceil(count / THREADS));
  }

  /**
   * Hands all dispatches to the device: in one pass, or with a timer in one for each stage. Returns the uniform buffer of
   * their parameters: `params`, if it is large enough.
   */
  submit(device: GPUDevice, kernels: Kernels, params: GPUBuffer | undefined, timer: StageTimer | undefined): GPUBuffer {
    const numbers = new Uint32Array((SLOT / 4) * this.#steps.length);
    this.#steps.forEach((step, at) => numbers.set(step.params, (SLOT / 4) * at));
    if (!params || params.size < numbers.byteLength) {
      params = device.createBuffer({ size: numbers.byteLength, usage: Usage.UNIFORM | Usage.COPY_DST });
    }
    device.queue.writeBuffer(params, 0, numbers);
    const encoder = device.createCommandEncoder();
    let pass: GPUComputePassEncoder | undefined;
    for (const [at, { stage, kernel, buffers, groups }] of this.#steps.entries()) {
      if (!pass || (timer && stage !== this.#steps[at - 1]!.stage)) {
        pass?.end();
        pass = encoder.beginComputePass(timer?.pass(stage));
      }
      const pipeline = kernels.get(kernel)!;
      const uniform = { binding: 0, resource: { buffer: params, offset: SLOT * at, size: PARAMS } };
      const storage = buffers.map(({ buffer, size }, index) => ({ binding: index + 1, resource: { buffer, size } }));
      const columns = Math.min(groups, MOST_GROUPS);
      pass.setPipeline(pipeline);
      pass.setBindGroup(0, device.createBindGroup({ layout: pipeline.getBindGroupLayout(0), entries: [uniform, ...storage] }));
      pass.dispatchWorkgroups(columns, Math.ceil(groups / Math.max(columns, 1)));
    }
    pass?.end();
    timer?.resolve(encoder);
    device.queue.submit([encoder.finish()]);
    return params;
  }
}
