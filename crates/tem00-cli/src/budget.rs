//! `tem00 budget`.

use std::io::Write;

use crate::{args::BudgetArgs, failure::Failure};

pub(crate) fn run(args: &BudgetArgs, _out: &mut impl Write) -> Result<(), Failure> {
    let _ = &args.setup;
    Ok(())
}
