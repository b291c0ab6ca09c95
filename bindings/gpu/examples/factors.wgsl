// The factor of every hit of a frame. Before it stand the function files of tem00-decorrelation and
// tem00-shading, and GpuStack::wgsl(0), which has that of tem00-speckle.

@group(1) @binding(0) var<uniform> frame: Tem00SpeckleFrame;
/// A point as it is now, and its normal.
@group(1) @binding(1) var<storage, read> hits: array<array<vec4<f32>, 2>>;
@group(1) @binding(2) var<storage, read_write> factors: array<f32>;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x < arrayLength(&factors) {
        factors[id.x] = tem00_factor(frame, hits[id.x][0].xyz, hits[id.x][1].xyz);
    }
}
