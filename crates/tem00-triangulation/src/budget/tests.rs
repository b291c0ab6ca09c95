use std::sync::atomic::AtomicBool;

use super::*;
use crate::{LineMethod, setup::tests::description};

#[test]
fn explore() {
    let mut d = description();
    d.detector.window = 31;
    for method in LineMethod::ALL {
        d.detector.method = method;
        let setup = Setup::new(d).unwrap();
        let start = std::time::Instant::now();
        let budget = Budget::new(&setup).unwrap();
        let t0 = start.elapsed();
        let start = std::time::Instant::now();
        let options = SimulationOptions {
            trials: 60,
            seed: 1,
        };
        let sim = simulate(&setup, options, |_| (), &AtomicBool::new(false)).unwrap();
        eprintln!(
            "{method}: {:?} {:?} line {:?} {:?}",
            t0,
            start.elapsed(),
            setup.line(),
            setup.light_level()
        );
        for term in budget.terms() {
            let mc = sim.term(term.source);
            eprintln!(
                "  {:14} {:.4e} {:?}",
                term.source.name(),
                term.contribution(),
                mc.map(|m| (m.uncertainty, m.standard_error))
            );
        }
        eprintln!(
            "  {:e} {:?} invalid {} law {:e} dorsch {:e}",
            budget.combined(),
            sim.total(),
            sim.invalid(),
            budget.line_law(),
            budget.dorsch()
        );
    }
}
