//! Allocation of patterns to the surfaces of a scene, so that none shows the speckle of another.

use tem00_speckle::{SpeckleError, StackNeeds, StackPlan};

use crate::TracerError;

/// Requirements of surfaces that move alike on their patterns.
#[derive(Clone, Debug)]
pub(super) struct Request {
    pub needs: StackNeeds,
    /// The largest motion of the pupil to either side of the reference frame, in its diameters.
    pub shifts: [f64; 2],
    /// The number of independent patterns that add up.
    pub parts: usize,
    /// The surfaces.
    pub surfaces: Vec<usize>,
}

/// Patterns of one size for surfaces that move alike, or for all that share it.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct PatternAllocation {
    /// The requirements, fulfilled or not.
    pub needs: StackNeeds,
    /// The largest motion of the pupil to either side of the reference frame, in its diameters.
    pub shifts: [f64; 2],
    pub stack: StackPlan,
    /// The number of stacks.
    pub count: usize,
    /// The number of positions in each stack: more than one if the memory does not hold a stack for
    /// each.
    pub positions: usize,
    /// The surfaces.
    pub surfaces: Vec<usize>,
}

impl PatternAllocation {
    /// Returns the bytes that the slices of all stacks take.
    pub(super) fn memory_bytes(&self) -> u64 {
        let stacks = u64::try_from(self.count).unwrap_or(u64::MAX);
        self.stack.memory_bytes().saturating_mul(stacks)
    }

    /// Returns the largest motions of the pupil that the slices tell apart, to either side of the
    /// reference frame, in its diameters.
    ///
    /// Where the path is too short for both, each gets its part of it.
    pub(super) fn reaches(&self) -> [f64; 2] {
        let reach = self.stack.reach();
        let [before, after] = self.shifts;
        if before == 0.0 || after == 0.0 {
            return [reach; 2];
        }
        [before, after].map(|part| reach * part / (before + after))
    }
}

/// Position in a stack at which a part of the speckle of a surface is looked up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Part {
    /// Its fraction of the light.
    pub fraction: f64,
    /// The stack, among those of the allocation.
    pub stack: usize,
    /// Its position in the stack, in periods along x and y.
    pub offset: [f64; 2],
}

/// The number of slices per pupil diameter from which a stack of one's own is worth more than a position
/// in one with more slices: the blend between them then exceeds the correlation law by up to 0.11.
const ENOUGH_SLICES: f64 = 16.0;

/// Allocates patterns to requests within a memory in bytes: a stack for each pattern, or else a position
/// in one stack for all. `asked` makes of a plan what the scene file asks for.
pub(super) fn allocate(
    requests: &[Request],
    memory: u64,
    asked: impl Fn(StackPlan) -> StackPlan,
) -> Result<Vec<PatternAllocation>, TracerError> {
    let positions: usize = requests.iter().map(|request| request.parts).sum();
    if positions > 1
        && let Some(stacks) = separate(requests, memory, &asked)?
    {
        let pairs = requests.iter().zip(stacks);
        return Ok(pairs
            .map(|(request, stack)| PatternAllocation {
                needs: request.needs,
                shifts: request.shifts,
                stack,
                count: request.parts,
                positions: 1,
                surfaces: request.surfaces.clone(),
            })
            .collect());
    }
    let (needs, shifts) = together(requests).ok_or(TracerError::Missing("a surface"))?;
    let candidates = StackPlan::candidates(&needs)?.into_iter().map(asked);
    let stack = StackPlan::first_within(candidates, memory).map_err(|error| match error {
        SpeckleError::MemoryLimit { needed, limit } => TracerError::PatternMemory {
            needed,
            allowed: limit,
        },
        other => other.into(),
    })?;
    Ok(vec![PatternAllocation {
        needs,
        shifts,
        stack,
        count: 1,
        positions,
        surfaces: requests.iter().flat_map(|r| r.surfaces.clone()).collect(),
    }])
}

/// The best plans with which each request gets its own stacks, if there are good ones.
fn separate(
    requests: &[Request],
    memory: u64,
    asked: impl Fn(StackPlan) -> StackPlan,
) -> Result<Option<Vec<StackPlan>>, TracerError> {
    let choices = requests
        .iter()
        .map(|Request { needs, .. }| {
            let good = |plan: &StackPlan| {
                needs.motion.is_none()
                    || (plan.slices_per_diameter() >= ENOUGH_SLICES && plan.holds_motion(needs))
            };
            Ok(StackPlan::candidates(needs)?
                .into_iter()
                .filter(good)
                .collect())
        })
        .collect::<Result<Vec<Vec<_>>, TracerError>>()?;
    let levels = choices.iter().map(Vec::len).max().unwrap_or(0);
    let plans = |level: usize| -> Option<Vec<StackPlan>> {
        let plans = choices
            .iter()
            .map(|plans| plans.get(level).or(plans.last()));
        plans.map(|plan| plan.copied().map(&asked)).collect()
    };
    let fits = |plans: &Vec<StackPlan>| {
        let needed = requests
            .iter()
            .zip(plans)
            .fold(0_u64, |sum, (request, plan)| {
                let stacks = u64::try_from(request.parts).unwrap_or(u64::MAX);
                sum.saturating_add(plan.memory_bytes().saturating_mul(stacks))
            });
        needed <= memory && plans.iter().all(|plan| plan.field(0).is_ok())
    };
    Ok((0..levels).filter_map(plans).find(fits))
}

/// Requirements of all requests on one stack.
fn together(requests: &[Request]) -> Option<(StackNeeds, [f64; 2])> {
    let requests = requests
        .iter()
        .map(|request| (request.needs, request.shifts));
    requests.reduce(|(mut needs, mut shifts), (other, further)| {
        for axis in [0, 1] {
            needs.region[axis] = needs.region[axis].max(other.region[axis]);
            shifts[axis] = shifts[axis].max(further[axis]);
        }
        let motion = needs.motion.or(other.motion);
        needs.motion = motion.map(|_| shifts[0] + shifts[1]);
        (needs, shifts)
    })
}

/// Returns how far beside its own position a surface looks up a further pattern, in periods along x and y; 0 is its own.
pub(super) fn position_beside(number: usize) -> [f64; 2] {
    if number == 0 {
        [0.0; 2]
    } else {
        offset(number)
    }
}

/// Returns the offset of the pattern `number` among several in one stack, in periods along x and y.
///
/// They are the points of the sequence of Roberts (2018), far apart from each other.
pub(super) fn offset(number: usize) -> [f64; 2] {
    /// The plastic ratio: the root of x³ = x + 1.
    const PLASTIC: f64 = 1.324_717_957_244_746;
    let number = number as f64;
    [
        (number / PLASTIC).fract(),
        (number / (PLASTIC * PLASTIC)).fract(),
    ]
}
