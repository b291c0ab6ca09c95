//! `tem00 design`.

use std::io::Write;

use crate::{args::DesignArgs, failure::Failure};

pub(crate) fn run(args: &DesignArgs, _out: &mut impl Write) -> Result<(), Failure> {
    let _ = &args.setup;
    Ok(())
}
