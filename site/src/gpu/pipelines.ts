import { WIDTH } from "./bodies.ts";
import shader from "./boxes.wgsl?raw";

/** The kernels of `boxes.wgsl`, and what draws, compiled for one device. */
export interface Pipelines {
  readonly step: GPUComputePipeline;
  readonly highlight: GPUComputePipeline;
  readonly picture: GPURenderPipeline;
}

export function compile(device: GPUDevice, format: GPUTextureFormat, dimensions: 2 | 3): Pipelines {
  const module = device.createShaderModule({ code: shader });
  const constants = { DIMENSIONS: dimensions, WIDTH };
  const corner: GPUVertexFormat = `float32x${dimensions}`;
  const corners = [0, 1].map((at) => ({ shaderLocation: at, offset: 4 * dimensions * at, format: corner }));
  const buffers: GPUVertexBufferLayout[] = [
    { arrayStride: 8 * dimensions, stepMode: "instance", attributes: corners },
    { arrayStride: 4, stepMode: "instance", attributes: [{ shaderLocation: 2, offset: 0, format: "uint32" }] },
  ];
  return {
    step: device.createComputePipeline({ layout: "auto", compute: { module, entryPoint: "step_bodies", constants } }),
    highlight: device.createComputePipeline({ layout: "auto", compute: { module, entryPoint: "highlight_pairs" } }),
    picture: device.createRenderPipeline({
      layout: "auto",
      vertex: { module, constants, buffers },
      primitive: { topology: "triangle-strip" },
      depthStencil: { format: "depth24plus", depthWriteEnabled: true, depthCompare: "less" },
      fragment: { module, targets: [{ format }] },
    }),
  };
}
