import common from "../../wgsl/common.wgsl";
import extract from "../../wgsl/extract.wgsl";
import filters from "../../wgsl/filters.wgsl";
import gather from "../../wgsl/gather.wgsl";
import leaves from "../../wgsl/leaves.wgsl";
import load from "../../wgsl/load.wgsl";
import mergePairs from "../../wgsl/merge_pairs.wgsl";
import order from "../../wgsl/order.wgsl";
import parents from "../../wgsl/parents.wgsl";
import scan from "../../wgsl/scan.wgsl";
import scanAdd from "../../wgsl/scan_add.wgsl";
import search from "../../wgsl/search.wgsl";
import sortCount from "../../wgsl/sort_count.wgsl";
import sortScatter from "../../wgsl/sort_scatter.wgsl";
import splitPairs from "../../wgsl/split_pairs.wgsl";
import summary from "../../wgsl/summary.wgsl";

/** An entry point of a shader. */
export type Kernel =
  | "load"
  | "copy_filters"
  | "extract"
  | "gather"
  | "count_digits"
  | "scatter_keys"
  | "scatter_values"
  | "scan"
  | "scan_add"
  | "order_boxes"
  | "leaves"
  | "parents"
  | "count_pairs"
  | "write_pairs"
  | "summarize"
  | "split_pairs"
  | "merge_pairs";

/** Where each entry point is. */
const sources: Record<Kernel, string> = {
  load,
  copy_filters: filters,
  extract,
  gather,
  count_digits: sortCount,
  scatter_keys: sortScatter,
  scatter_values: sortScatter,
  scan,
  scan_add: scanAdd,
  order_boxes: order,
  leaves,
  parents,
  count_pairs: search,
  write_pairs: search,
  summarize: summary,
  split_pairs: splitPairs,
  merge_pairs: mergePairs,
};

/** All kernels, compiled for one device. */
export type Kernels = ReadonlyMap<Kernel, GPUComputePipeline>;

/** The kernels of each device: compiling them takes from a moment to seconds, and all finders of a device share them. */
const kernels = new WeakMap<GPUDevice, Promise<Kernels>>();

/** The kernels of a device, compiled if no finder has had them compiled before. */
export function kernelsOf(device: GPUDevice): Promise<Kernels> {
  const known = kernels.get(device);
  if (known) return known;
  const compiled = compile(device);
  kernels.set(device, compiled);
  // The next finder tries again.
  compiled.catch(() => kernels.delete(device));
  return compiled;
}

async function compile(device: GPUDevice): Promise<Kernels> {
  const compileOne = async ([name, source]: [string, string]) => {
    const module = device.createShaderModule({ label: name, code: `${common}\n${source}` });
    const pipeline = await device.createComputePipelineAsync({ label: name, layout: "auto", compute: { module, entryPoint: name } });
    return [name as Kernel, pipeline] as const;
  };
  return new Map(await Promise.all(Object.entries(sources).map(compileOne)));
}
