//! `tem00 calibrate`.

use std::io::Write;

use crate::{args::CalibrateArgs, failure::Failure};

pub(crate) fn run(args: &CalibrateArgs, _out: &mut impl Write) -> Result<(), Failure> {
    let _ = &args.folder;
    Ok(())
}
