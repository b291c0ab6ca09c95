//! `tem00 triangulate`.

use std::io::Write;

use crate::{args::TriangulateArgs, failure::Failure};

pub(crate) fn run(args: &TriangulateArgs, _out: &mut impl Write) -> Result<(), Failure> {
    let _ = &args.scene;
    Ok(())
}
