//! Functions of a WGSL text, called on the card for many arguments.

use tem00_gpu::{
    Gpu,
    wgpu::{
        self, BindGroupDescriptor, BindGroupEntry, BufferUsages, ComputePipelineDescriptor,
        ShaderModuleDescriptor, ShaderSource,
        util::{BufferInitDescriptor, DeviceExt as _},
    },
};

/// Threads of a workgroup.
const GROUP: usize = 64;

/// Evaluates `body` for each group of `INPUTS` numbers of `inputs`, on the card.
///
/// `body` is WGSL that reads `input(0)`, `input(1)`, … and calls `output(0, value)`,
/// `output(1, value)`, …, both `f32`; `source` holds the functions that it calls. Integers travel
/// by `bitcast`.
pub(crate) fn evaluate<const INPUTS: usize, const OUTPUTS: usize>(
    gpu: &Gpu,
    source: &str,
    body: &str,
    inputs: &[[f32; INPUTS]],
) -> Vec<[f32; OUTPUTS]> {
    let text = format!(
        "{source}
        @group(0) @binding(0) var<storage, read> inputs_: array<f32>;
        @group(0) @binding(1) var<storage, read_write> outputs_: array<f32>;
        var<private> thread_: u32;
        fn input(i: u32) -> f32 {{ return inputs_[thread_ * {INPUTS}u + i]; }}
        fn output(i: u32, value: f32) {{ outputs_[thread_ * {OUTPUTS}u + i] = value; }}
        @compute @workgroup_size({GROUP})
        fn main(@builtin(global_invocation_id) id: vec3<u32>, \
            @builtin(num_workgroups) groups: vec3<u32>) {{
            thread_ = id.y * groups.x * {GROUP}u + id.x;
            if thread_ >= {count}u {{ return; }}
            {body}
        }}",
        count = inputs.len(),
    );
    let outputs = run(gpu, &text, inputs.as_flattened(), inputs.len(), OUTPUTS);
    outputs.as_chunks().0.to_vec()
}

fn run(gpu: &Gpu, text: &str, inputs: &[f32], count: usize, each: usize) -> Vec<f32> {
    let device = gpu.device();
    let module = device.create_shader_module(ShaderModuleDescriptor {
        label: None,
        source: ShaderSource::Wgsl(text.into()),
    });
    let pipeline = device.create_compute_pipeline(&ComputePipelineDescriptor {
        label: None,
        layout: None,
        module: &module,
        entry_point: None,
        compilation_options: <_>::default(),
        cache: None,
    });
    let buffer = |values: &[f32], usage| {
        device.create_buffer_init(&BufferInitDescriptor {
            label: None,
            contents: bytemuck::cast_slice(values),
            usage,
        })
    };
    let room = vec![0.0; count * each];
    let arguments = buffer(inputs, BufferUsages::STORAGE);
    let results = buffer(&room, BufferUsages::STORAGE | BufferUsages::COPY_SRC);
    let read = buffer(&room, BufferUsages::MAP_READ | BufferUsages::COPY_DST);
    let entries = [&arguments, &results].map(wgpu::Buffer::as_entire_binding);
    let entries = [0, 1].map(|i| BindGroupEntry {
        binding: i,
        resource: entries[i as usize].clone(),
    });
    let bindings = device.create_bind_group(&BindGroupDescriptor {
        label: None,
        layout: &pipeline.get_bind_group_layout(0),
        entries: &entries,
    });
    let mut encoder = device.create_command_encoder(&<_>::default());
    let mut pass = encoder.begin_compute_pass(&<_>::default());
    pass.set_pipeline(&pipeline);
    pass.set_bind_group(0, &bindings, &[]);
    let groups = u32::try_from(count.div_ceil(GROUP)).expect("a count below 2³²");
    let wide = groups.min(1 << 12);
    pass.dispatch_workgroups(wide, groups.div_ceil(wide), 1);
    drop(pass);
    encoder.copy_buffer_to_buffer(&results, 0, &read, 0, read.size());
    gpu.queue().submit([encoder.finish()]);
    gpu.read(&read).expect("results")
}

#[test]
fn every_input_has_its_output() {
    let gpu = Gpu::new().expect("an adapter");
    let inputs: Vec<_> = (0_u16..20_000).map(|i| [f32::from(i), 2.0]).collect();
    let sums = evaluate(&gpu, "", "output(0, input(0) + input(1));", &inputs);
    assert_eq!(
        sums,
        inputs.iter().map(|[a, b]| [a + b]).collect::<Vec<_>>()
    );
}
