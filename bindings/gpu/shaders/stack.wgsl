// A stack where `GpuStack::bind_group` has it, for the functions of tem00-speckle: bind it as group
// GROUP.

@group(GROUP) @binding(0) var<uniform> tem00_stack: Tem00Stack;
@group(GROUP) @binding(1) var<storage, read> tem00_stack_coefficients_: array<vec2<f32>>;
@group(GROUP) @binding(2) var<storage, read> tem00_stack_laws_: array<array<vec4<f32>, 14>>;

fn tem00_stack_coefficient(slice: u32, cell: vec2<u32>) -> vec2<f32> {
    let row = slice * tem00_stack.size.y + cell.y;
    return tem00_stack_coefficients_[row * tem00_stack.size.x + cell.x];
}

fn tem00_stack_law(slice: u32, row: u32) -> vec4<f32> {
    return tem00_stack_laws_[slice][row];
}
