//! Allocation of patterns to the surfaces of a scene, so that none shows the speckle of another.

use tem00_geometry::Refusal;
use tem00_numerics::cast::to_i64;
use tem00_speckle::{SpeckleError, StackNeeds, StackPlan};
use tem00_tracer::TracerError;

/// Requirements of surfaces that move alike on their patterns.
#[derive(Clone, Debug)]
pub(super) struct Request {
    pub needs: StackNeeds,
    /// The largest motion of the pupil to either side of the reference frame, in its diameters.
    pub shifts: [f64; 2],
    /// Requirements of each frame, where a frame can have its own slices.
    pub frames: Option<FrameRequest>,
    /// The number of independent patterns that add up.
    pub parts: usize,
    /// The surfaces.
    pub surfaces: Vec<usize>,
}

/// Requirements of single frames on their slices of a path without end.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct FrameRequest {
    /// Width and height of the region that frames look up from shared slices, in pixels.
    pub region: [f64; 2],
    /// Range of each frame along the path, in pupil diameters.
    pub spans: Vec<[f64; 2]>,
    /// Offset of each frame across the path, where frames do not share one line.
    pub across: Option<Vec<f64>>,
}

/// A stack for a request.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Choice {
    stack: StackPlan,
    needs: StackNeeds,
    /// Whether each frame has its own slices.
    by_frame: bool,
}

/// Patterns of one size for surfaces that move alike, or for all that share it.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct PatternAllocation {
    /// The requirements, fulfilled or not.
    pub needs: StackNeeds,
    /// The largest motion of the pupil to either side of the reference frame, in its diameters.
    pub shifts: [f64; 2],
    pub stack: StackPlan,
    /// The lattice points about which the slices of each frame lie, whole diameters along the path;
    /// empty where one stack holds the slices of all frames.
    pub middles: Vec<[i64; 2]>,
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

    /// Returns the largest motions of the pupil that the slices distinguish, to either side of the
    /// reference frame, in its diameters.
    pub(super) fn reaches(&self) -> [f64; 2] {
        if !self.middles.is_empty() {
            return [f64::INFINITY; 2];
        }
        self.stack.reaches(self.shifts)
    }
}

/// Position in a stack at which a part of the speckle of a surface is looked up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Part {
    /// Its fraction of the light.
    pub fraction: f64,
    /// The index of the stack in the allocation.
    pub stack: usize,
    /// Its position in the stack, in periods along x and y.
    pub offset: [f64; 2],
}

/// The path that the slices of a frame cover beyond its span, in pupil diameters: half a diameter
/// to either side, since the slices lie about a whole diameter, and a quarter for points that no
/// ray has met.
const MARGIN: f64 = 1.5;

impl Choice {
    /// Returns the same requirements with the settings of the scene file.
    fn asked(self, asked: impl Fn(StackPlan) -> StackPlan) -> Self {
        Self {
            stack: asked(self.stack),
            ..self
        }
    }
}

impl FrameRequest {
    /// Returns the requirements of the frame that asks for most.
    fn needs(&self, whole: &StackNeeds) -> StackNeeds {
        let spans = self.spans.iter().map(|[low, high]| high - low);
        StackNeeds {
            region: self.region,
            motion: whole.motion.map(|_| MARGIN + spans.fold(0.0, f64::max)),
            // Of two frames the second, too, has a path as long as it needs.
            frames: u32::MAX,
            ..*whole
        }
    }

    /// Returns the requirements of both.
    fn with(mut self, other: &Self) -> Self {
        for axis in [0, 1] {
            self.region[axis] = self.region[axis].max(other.region[axis]);
        }
        for ([low, high], [from, to]) in self.spans.iter_mut().zip(&other.spans) {
            (*low, *high) = (low.min(*from), high.max(*to));
        }
        self
    }

    fn middles(&self, stack: &StackPlan) -> Vec<[i64; 2]> {
        let [along, across] = stack.diameter().map(|diameter| diameter as f64);
        let middle = |(frame, [low, high]): (usize, &[f64; 2])| {
            let beside = self.across.as_ref().map_or(0.0, |frames| frames[frame]);
            let diameters = (0.5 * (low + high)).round();
            [diameters * along, beside * across].map(|points| to_i64(points.round()))
        };
        self.spans.iter().enumerate().map(middle).collect()
    }
}

impl Request {
    /// Returns the stacks that fulfil the request, the best first.
    ///
    /// Of stacks with as many slices per diameter, one stack for all frames comes before one stack
    /// for each frame.
    fn choices(&self) -> Result<Vec<Choice>, TracerError> {
        let of = |needs: StackNeeds, by_frame: bool| {
            let candidates = StackPlan::candidates(&needs)?.into_iter();
            let holds = move |stack: &StackPlan| stack.holds_motion(&needs);
            let choice = move |stack| Choice {
                stack,
                needs,
                by_frame,
            };
            Ok::<_, TracerError>(candidates.filter(holds).map(choice))
        };
        let mut choices: Vec<_> = of(self.needs, false)?.collect();
        if let Some(frames) = &self.frames {
            if frames.across.is_some() {
                choices.clear();
            }
            choices.extend(of(frames.needs(&self.needs), true)?);
            let slices = |c: &Choice| c.stack.slices_per_diameter();
            let holds_region = |c: &Choice| c.stack.holds_region(&c.needs);
            choices.sort_by(|a, b| {
                let by_region = holds_region(b).cmp(&holds_region(a));
                by_region.then(slices(b).total_cmp(&slices(a)))
            });
        }
        Ok(choices)
    }

    fn allocation(&self, choice: &Choice, [count, positions]: [usize; 2]) -> PatternAllocation {
        let frames = self.frames.as_ref().filter(|_| choice.by_frame);
        PatternAllocation {
            needs: StackNeeds {
                motion: self.needs.motion,
                ..choice.needs
            },
            shifts: self.shifts,
            stack: choice.stack,
            middles: frames.map_or_else(Vec::new, |frames| frames.middles(&choice.stack)),
            count,
            positions,
            surfaces: self.surfaces.clone(),
        }
    }

    /// Returns the requirements of both on one stack.
    fn with(mut self, other: &Self) -> Self {
        for axis in [0, 1] {
            self.needs.region[axis] = self.needs.region[axis].max(other.needs.region[axis]);
            self.shifts[axis] = self.shifts[axis].max(other.shifts[axis]);
        }
        let motion = self.needs.motion.or(other.needs.motion);
        self.needs.motion = motion.map(|_| self.shifts[0] + self.shifts[1]);
        let frames = self.frames.zip(other.frames.as_ref());
        self.frames = frames.map(|(own, other)| own.with(other));
        self.parts += other.parts;
        self.surfaces.extend(&other.surfaces);
        self
    }
}

/// Allocates patterns to requests within a memory in bytes: a stack for each pattern, or else
/// positions in one stack for all patterns. `asked` applies the settings of the scene file to a
/// plan.
pub(super) fn allocate(
    requests: &[Request],
    memory: u64,
    asked: impl Fn(StackPlan) -> StackPlan,
) -> Result<Vec<PatternAllocation>, TracerError> {
    let positions: usize = requests.iter().map(|request| request.parts).sum();
    if positions > 1
        && let Some(choices) = separate(requests, memory, &asked)?
    {
        let pairs = requests.iter().zip(&choices);
        let allocations =
            pairs.map(|(request, choice)| request.allocation(choice, [request.parts, 1]));
        return Ok(allocations.collect());
    }
    let all = requests.iter().cloned();
    let all = all.reduce(|all, request| all.with(&request));
    let all = all.ok_or_else(|| Refusal::new("number of surfaces", 0.0, "at least 1"))?;
    let choices: Vec<_> = all.choices()?.iter().map(|c| c.asked(&asked)).collect();
    let stacks = choices.iter().map(|choice| choice.stack);
    let stack = StackPlan::first_within(stacks, memory).map_err(|error| match error {
        SpeckleError::MemoryLimit { needed, limit } => TracerError::PatternMemory {
            needed,
            allowed: limit,
        },
        other => other.into(),
    })?;
    let first = choices.iter().find(|choice| choice.stack == stack);
    let allocation = first.map(|choice| all.allocation(choice, [1, positions]));
    Ok(allocation.into_iter().collect())
}

/// The best stacks with which each request gets its own, if there are good ones.
fn separate(
    requests: &[Request],
    memory: u64,
    asked: impl Fn(StackPlan) -> StackPlan,
) -> Result<Option<Vec<Choice>>, TracerError> {
    let good = |Choice { stack, needs, .. }: &Choice| {
        needs.motion.is_none() || (stack.blends_closely() && stack.holds_motion(needs))
    };
    let choices = requests
        .iter()
        .map(|request| Ok(request.choices()?.into_iter().filter(good).collect()))
        .collect::<Result<Vec<Vec<Choice>>, TracerError>>()?;
    let levels = choices.iter().map(Vec::len).max().unwrap_or(0);
    let at = |level: usize| -> Option<Vec<Choice>> {
        let choices = choices.iter();
        let at_level = choices.map(|list| list.get(level).or(list.last()));
        at_level.map(|choice| Some(choice?.asked(&asked))).collect()
    };
    let fits = |choices: &Vec<Choice>| {
        let needed = requests
            .iter()
            .zip(choices)
            .fold(0_u64, |sum, (request, choice)| {
                let stacks = u64::try_from(request.parts).unwrap_or(u64::MAX);
                sum.saturating_add(choice.stack.memory_bytes().saturating_mul(stacks))
            });
        needed <= memory && choices.iter().all(|choice| choice.stack.field(0).is_ok())
    };
    Ok((0..levels).filter_map(at).find(fits))
}
