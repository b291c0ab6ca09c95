// Intensities at many points. Before it stand the functions of tem00-speckle and the bindings of a
// stack.

@group(1) @binding(0) var<storage, read> points: array<f32>;
@group(1) @binding(1) var<storage, read_write> intensities: array<f32>;

@compute @workgroup_size(64)
fn look_up(
    @builtin(global_invocation_id) id: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
) {
    let point = id.y * groups.x * 64u + id.x;
    if point < arrayLength(&intensities) {
        let at = 3u * point;
        intensities[point] =
            tem00_stack_intensity(tem00_stack, points[at], points[at + 1u], points[at + 2u]);
    }
}
