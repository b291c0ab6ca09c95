use std::io::Cursor;

use tiff::{
    decoder::{Decoder, DecodingResult, Limits},
    tags::Tag,
};

use super::{Components, ImageError};

/// A decoder of a file in memory.
pub(super) type FileDecoder<'a> = Decoder<Cursor<&'a [u8]>>;

/// The pixels of a file.
pub(super) struct Pixels {
    pub(super) components: Components,
    pub(super) values: Vec<f32>,
    pub(super) bit_depth: Option<u32>,
    pub(super) remark: String,
}

/// Returns the number that a tag holds, if it is one.
pub(super) fn number<T: TryFrom<u64>>(decoder: &mut FileDecoder<'_>, tag: Tag) -> Option<T> {
    decoder.find_tag_unsigned(tag).ok().flatten()
}

/// Reads all planes, at most `bytes` bytes, and returns them with their number.
pub(super) fn read_all(
    decoder: FileDecoder<'_>,
    bytes: usize,
) -> Result<(DecodingResult, usize), ImageError> {
    let mut limits = Limits::default();
    limits.decoding_buffer_size = bytes;
    limits.intermediate_buffer_size = limits.intermediate_buffer_size.max(bytes);
    let mut read = DecodingResult::U8(Vec::new());
    let layout = decoder
        .with_limits(limits)
        .read_image_to_buffer(&mut read)?;
    Ok((read, layout.planes))
}
