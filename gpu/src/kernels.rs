//! The compiled shaders.

use wgpu::ComputePipeline;

/// Makes the enum of kernels and their table from one list.
macro_rules! kernels {
    ($($kernel:ident, $file:literal, $entry:literal;)*) => {
        /// An entry point of a shader.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum Kernel {
            $($kernel,)*
        }

        impl Kernel {
            const ALL: &'static [Source] = &[$(Source {
                name: $entry,
                code: concat!(include_str!("../wgsl/common.wgsl"), "\n", include_str!(concat!("../wgsl/", $file))),
            },)*];
        }
    };
}

/// Where a kernel is.
struct Source {
    name: &'static str,
    code: &'static str,
}

kernels! {
    Load, "load.wgsl", "load";
    CopyFilters, "filters.wgsl", "copy_filters";
    Extract, "extract.wgsl", "extract";
    Gather, "gather.wgsl", "gather";
    CountDigits, "sort_count.wgsl", "count_digits";
    ScatterKeys, "sort_scatter.wgsl", "scatter_keys";
    ScatterValues, "sort_scatter.wgsl", "scatter_values";
    Scan, "scan.wgsl", "scan";
    ScanAdd, "scan_add.wgsl", "scan_add";
    Order, "order.wgsl", "order_boxes";
    Leaves, "leaves.wgsl", "leaves";
    Parents, "parents.wgsl", "parents";
    CountPairs, "search.wgsl", "count_pairs";
    CountTests, "search.wgsl", "count_tests";
    WritePairs, "search.wgsl", "write_pairs";
    Summarize, "summary.wgsl", "summarize";
    SplitPairs, "split_pairs.wgsl", "split_pairs";
    MergePairs, "merge_pairs.wgsl", "merge_pairs";
}

/// All kernels, compiled for one device.
#[derive(Debug)]
pub struct Kernels {
    pipelines: Vec<ComputePipeline>,
}

impl Kernels {
    pub fn new(device: &wgpu::Device) -> Self {
        let compile = |source: &Source| {
            let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
                label: Some(source.name),
                source: wgpu::ShaderSource::Wgsl(source.code.into()),
            });
            device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
                label: Some(source.name),
                layout: None,
                module: &module,
                entry_point: Some(source.name),
                compilation_options: Default::default(),
                cache: None,
            })
        };
        Self { pipelines: Kernel::ALL.iter().map(compile).collect() }
    }

    pub fn get(&self, kernel: Kernel) -> &ComputePipeline {
        &self.pipelines[kernel as usize]
    }
}
