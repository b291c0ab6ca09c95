use tem00_numerics::Grid;

/// Where a walk through n states, each left for the next one at its own rate, stands after a time.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Passage {
    /// The probability that the last state has been left: that a sum of n exponential variables of
    /// these rates is at most the time.
    pub(crate) absorbed: f64,
    /// The probability that it has not.
    pub(crate) surviving: f64,
    /// The probability of the last state.
    pub(crate) last: f64,
}

/// Returns where the walk that starts in the first state stands after `time`.
///
/// The matrix of the probabilities to get from one state to another within a short time is a series
/// of positive terms; it is then squared until the time is reached. As nothing is ever subtracted,
/// rates may be equal, nearly equal or far apart, and each probability keeps its digits however
/// small it is. The time taken grows as n³.
pub(crate) fn passage(rates: &[f64], time: f64) -> Passage {
    let fastest = rates.iter().fold(0.0_f64, |a, &b| a.max(b));
    let mut step = time;
    let mut doublings = 0;
    while fastest * step > 1.0 {
        step *= 0.5;
        doublings += 1;
    }
    let mut matrix = short_step(rates, fastest, step);
    for _ in 0..doublings {
        step *= 2.0;
        matrix = squared(&matrix);
        for (state, &rate) in rates.iter().enumerate() {
            matrix[(state, state)] = (-rate * step).exp();
        }
    }
    let (end, start) = (rates.len(), matrix.row(0));
    Passage {
        absorbed: start[end],
        surviving: start[..end].iter().sum(),
        last: start[end - 1],
    }
}

/// Returns the matrix, to state `x` from state `y`, for a step no longer than the shortest stay: the
/// mean over the Poisson number of jumps of a chain that jumps at the fastest rate.
fn short_step(rates: &[f64], fastest: f64, step: f64) -> Grid<f64> {
    // Reaching the end takes n jumps, and 1/24! of them more no longer count.
    let jumps = rates.len() + 24;
    let states = rates.len() + 1;
    let rate = |state: usize| rates.get(state).map_or(0.0, |rate| rate / fastest);
    let mut matrix = Grid::filled(states, states, 0.0);
    for from in 0..states {
        let mut walk = vec![0.0; states];
        walk[from] = 1.0;
        let mut weight = (-fastest * step).exp();
        for jump in 1..=jumps {
            for (to, &probability) in walk.iter().enumerate().skip(from) {
                matrix[(to, from)] += weight * probability;
            }
            for to in (from..states).rev() {
                let arriving = if to > from {
                    walk[to - 1] * rate(to - 1)
                } else {
                    0.0
                };
                walk[to] = walk[to] * (1.0 - rate(to)) + arriving;
            }
            weight *= fastest * step / jump as f64;
        }
    }
    matrix
}

/// Returns the square of an upper triangular matrix.
fn squared(matrix: &Grid<f64>) -> Grid<f64> {
    let states = matrix.width();
    Grid::from_fn(states, states, |to, from| {
        if to < from {
            return 0.0;
        }
        (from..=to)
            .map(|by| matrix[(by, from)] * matrix[(to, by)])
            .sum()
    })
}
