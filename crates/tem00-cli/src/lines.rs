//! `tem00 lines`.

use std::io::Write;

use crate::{args::LinesArgs, failure::Failure};

pub(crate) fn run(args: &LinesArgs, _out: &mut impl Write) -> Result<(), Failure> {
    let _ = &args.images;
    Ok(())
}
