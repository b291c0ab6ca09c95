//! Text form of a plan.

use core::fmt;

use super::{PatternPlan, SpecklePlan};
use crate::speckle::allocation::PatternAllocation;

impl fmt::Display for SpecklePlan {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let patterns = self.patterns.iter().enumerate();
        let lines = patterns.flat_map(|(laser, pattern)| {
            let lines: Vec<_> = pattern.to_string().lines().map(str::to_owned).collect();
            lines.into_iter().map(move |line| (laser, line))
        });
        for (number, (laser, line)) in lines.enumerate() {
            if number > 0 {
                writeln!(f)?;
            }
            write!(f, "laser {laser}: {line}")?;
        }
        Ok(())
    }
}

impl fmt::Display for PatternPlan {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (index, allocation) in self.allocations.iter().enumerate() {
            if index > 0 {
                writeln!(f)?;
            }
            if self.allocations.len() > 1 {
                write!(f, "{}: ", self.surfaces(allocation))?;
            }
            self.line(allocation, f)?;
        }
        Ok(())
    }
}

impl PatternPlan {
    /// The names of the first surfaces of an allocation, and how many more there are.
    fn surfaces(&self, allocation: &PatternAllocation) -> String {
        const SHOWN: usize = 3;
        let names = allocation
            .surfaces
            .iter()
            .map(|&surface| &self.names[surface]);
        let shown: Vec<_> = names.take(SHOWN).map(|name| format!("`{name}`")).collect();
        let shown = shown.join(", ");
        match allocation.surfaces.len().saturating_sub(SHOWN) {
            0 => shown,
            more => format!("{shown} and {more} more"),
        }
    }

    fn line(&self, allocation: &PatternAllocation, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let PatternAllocation { stack, needs, .. } = allocation;
        let [width, height] = needs.region;
        write!(
            f,
            "speckles of {:.3} pixels at {:.1} nm; C = {}, {} the {:.1} × {:.1} speckles \
             ({width:.0} × {height:.0} pixels) of the image{}; Q = {}; ",
            needs.speckle_size,
            self.wavelength * 1e9,
            Sides(stack.diameter()),
            if stack.holds_region(needs) {
                "at least"
            } else {
                "LESS than"
            },
            width / needs.speckle_size,
            height / needs.speckle_size,
            if self.chosen {
                ""
            } else {
                ", as the scene asks"
            },
            Sides(stack.size()),
        )?;
        match needs.motion {
            None => write!(f, "one slice, since nothing moves; ")?,
            Some(motion) => write!(
                f,
                "{} slices{} for a motion of up to {motion:.2} pupil diameters; ",
                stack.path().slice_count(),
                if allocation.middles.is_empty() {
                    ""
                } else {
                    " at a time"
                }
            )?,
        }
        if let Some(bandwidth) = self.bandwidth(allocation) {
            write!(
                f,
                "a linewidth that displaces the pupil by up to {:.2} diameters; ",
                bandwidth.reach,
            )?;
        }
        if allocation.count > 1 {
            write!(f, "{} patterns that add up; ", allocation.count)?;
        }
        if allocation.positions > 1 {
            write!(
                f,
                "{} positions in one pattern, for the memory does NOT hold more: each repeats what \
                 another shows elsewhere in the image; ",
                allocation.positions
            )?;
        }
        let mebibytes = allocation.memory_bytes() as f64 / f64::from(1 << 20);
        write!(f, "{mebibytes:.1} MiB")
    }
}

/// Sides of a pattern: one number for a square, two otherwise.
struct Sides([usize; 2]);

impl fmt::Display for Sides {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [width, height] = self.0;
        match width == height {
            true => write!(f, "{width}"),
            false => write!(f, "{width} × {height}"),
        }
    }
}
