//! The texts of shaders without their comments, which a page need not load.

/// The code of a text.
macro_rules! code {
    ($text:expr) => {{
        const TEXT: &str = $text;
        const LENGTH: usize = $crate::code::without_comments::<0>(TEXT).1;
        const CODE: [u8; LENGTH] = $crate::code::without_comments(TEXT).0;
        const {
            match str::from_utf8(&CODE) {
                Ok(code) => code,
                Err(_) => TEXT,
            }
        }
    }};
}
pub(crate) use code;

/// The functions of lights and of hits; those of a stack are beside its bindings.
pub(crate) const FUNCTIONS: [&str; 3] = [
    code!(tem00_beam::closed_form::WGSL),
    code!(tem00_decorrelation::closed_form::WGSL),
    code!(tem00_shading::WGSL),
];

/// Returns the first bytes of a text without its lines of comments and its indents, and how many it
/// has.
pub(crate) const fn without_comments<const N: usize>(text: &str) -> ([u8; N], usize) {
    let text = text.as_bytes();
    let (mut kept, mut length) = ([0; N], 0);
    let (mut is_indent, mut is_comment) = (true, false);
    let mut i = 0;
    while i < text.len() {
        if is_indent && text[i] != b' ' {
            // No line of code begins so.
            is_comment = text[i] == b'/' || text[i] == b'\n';
            is_indent = false;
        }
        if !is_indent && !is_comment {
            if length < N {
                kept[length] = text[i];
            }
            length += 1;
        }
        is_indent |= text[i] == b'\n';
        i += 1;
    }
    (kept, length)
}
