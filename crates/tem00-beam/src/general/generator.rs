use glam::{DMat2, DVec2};

/// The phase space of a beam as the image of four independent standard normal numbers `a`, `b`:
///
/// ```text
/// x(z) = P a + (Q + z T) b        position
/// s    =           T b            slope
/// ```
///
/// Any normal density in four dimensions has this form. Its covariances are sums of squares of the
/// columns, so nothing cancels near a focus far from z = 0, and `P` is exactly the spread of
/// positions at a given slope, which travel through free space does not change.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Generator {
    pub(super) spread: DMat2,
    pub(super) shift: DMat2,
    pub(super) slope: DMat2,
}

impl Generator {
    /// Returns the form in which slopes depend on the last two numbers only, from columns of any
    /// form. A rotation of the four numbers, which leaves their density alone, takes one to the
    /// other.
    pub(super) fn from_columns(mut position: [DVec2; 4], mut slope: [DVec2; 4]) -> Self {
        const ORDER: [(usize, usize, usize); 5] =
            [(0, 3, 0), (1, 3, 0), (2, 3, 0), (0, 2, 1), (1, 2, 1)];
        let mixed = slope[0] != DVec2::ZERO || slope[1] != DVec2::ZERO;
        for (i, j, row) in ORDER.into_iter().filter(|_| mixed) {
            let (a, b) = (slope[i][row], slope[j][row]);
            if a == 0.0 {
                continue;
            }
            let turn = DVec2::new(b, a) / b.hypot(a);
            rotate_columns(&mut position, (i, j), turn);
            rotate_columns(&mut slope, (i, j), turn);
            slope[i][row] = 0.0;
        }
        Self {
            spread: DMat2::from_cols(position[0], position[1]),
            shift: DMat2::from_cols(position[2], position[3]),
            slope: DMat2::from_cols(slope[2], slope[3]),
        }
    }

    /// Returns the columns of the position at z.
    pub(super) fn position_columns(&self, z: f64) -> [DVec2; 4] {
        let shift = self.shift + self.slope * z;
        [
            self.spread.x_axis,
            self.spread.y_axis,
            shift.x_axis,
            shift.y_axis,
        ]
    }

    /// Returns the columns of the slope.
    pub(super) fn slope_columns(&self) -> [DVec2; 4] {
        [
            DVec2::ZERO,
            DVec2::ZERO,
            self.slope.x_axis,
            self.slope.y_axis,
        ]
    }

    /// Returns the two symplectic eigenvalues of the covariance, in metres, the smaller one first.
    ///
    /// They are the singular values ν of the antisymmetric 4×4 matrix `Fᵀ J F` of the generator F,
    /// whose only non-zero blocks are `n = Pᵀ T` and `τ = q₀·t₁ − q₁·t₀`:
    ///
    /// ```text
    /// (ν₂ ± ν₁)² = (n₀₀ ± n₁₁)² + (n₀₁ ∓ n₁₀)² + τ²      if det n ≥ 0
    ///  ν₁ · ν₂   = |det P · det T|
    /// ```
    pub(super) fn symplectic_eigenvalues(&self) -> [f64; 2] {
        let n = self.spread.transpose() * self.slope;
        let [t0, t1] = [self.slope.x_axis, self.slope.y_axis];
        let tau = self.shift.x_axis.dot(t1) - self.shift.y_axis.dot(t0);
        let sum = length3(n.x_axis.x + n.y_axis.y, n.y_axis.x - n.x_axis.y, tau);
        let difference = length3(n.x_axis.x - n.y_axis.y, n.y_axis.x + n.x_axis.y, tau);
        let larger = 0.5 * (sum + difference);
        let product = (self.spread.determinant() * self.slope.determinant()).abs();
        [product / larger, larger]
    }

    /// Returns `⟨x s_y − y s_x⟩`, in metres.
    pub(super) fn twist(&self) -> f64 {
        self.shift.x_axis.perp_dot(self.slope.x_axis)
            + self.shift.y_axis.perp_dot(self.slope.y_axis)
    }

    pub(super) fn is_finite(&self) -> bool {
        [self.spread, self.shift, self.slope]
            .iter()
            .all(DMat2::is_finite)
    }
}

/// Turns the columns i and j by the angle whose cosine and sine are `turn`.
fn rotate_columns(columns: &mut [DVec2; 4], (i, j): (usize, usize), turn: DVec2) {
    let (a, b) = (columns[i], columns[j]);
    columns[i] = turn.x * a - turn.y * b;
    columns[j] = turn.y * a + turn.x * b;
}

fn length3(x: f64, y: f64, z: f64) -> f64 {
    x.hypot(y).hypot(z)
}

/// The ellipse `Σ = Σ_i c_i c_iᵀ` of four columns: the positions of a beam at one z.
///
/// Columns are kept relative to the largest component, so that no square leaves the numbers.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ellipse {
    columns: [DVec2; 4],
    scale: f64,
    /// √det Σ in units of scale²: by Cauchy and Binet a sum of squares.
    root_determinant: f64,
}

impl Ellipse {
    pub(super) fn new(columns: [DVec2; 4]) -> Self {
        let scale = columns
            .iter()
            .fold(0.0, |max: f64, c| max.max(c.abs().max_element()));
        let columns = columns.map(|column| column / scale);
        let [a, b, c, d] = columns;
        let pairs = [(a, b), (a, c), (a, d), (b, c), (b, d), (c, d)];
        let squares: f64 = pairs.iter().map(|(p, q)| p.perp_dot(*q).powi(2)).sum();
        Self {
            columns,
            scale,
            // Zero only beyond 1e240 m, where the square underflows.
            root_determinant: squares.sqrt().max(f64::MIN_POSITIVE),
        }
    }

    /// Returns the standard deviations along the principal axes, the larger one first.
    pub(super) fn deviations(&self) -> [f64; 2] {
        let sigma = covariance(&self.columns, &self.columns);
        let (sum, difference) = (
            sigma.x_axis.x + sigma.y_axis.y,
            sigma.x_axis.x - sigma.y_axis.y,
        );
        let larger = (0.5 * (sum + difference.hypot(2.0 * sigma.x_axis.y))).sqrt();
        [larger, self.root_determinant / larger].map(|deviation| deviation * self.scale)
    }

    /// Returns the angle from x to the major axis, in (−π/2, π/2].
    pub(super) fn orientation(&self) -> f64 {
        let sigma = covariance(&self.columns, &self.columns);
        let difference = sigma.x_axis.x - sigma.y_axis.y;
        0.5 * (2.0 * sigma.x_axis.y).atan2(difference)
    }

    /// Returns the four numbers of least norm that give `position`: their mean given the position.
    /// The square of the norm is `xᵀ Σ⁻¹ x`.
    pub(super) fn coordinates(&self, position: DVec2) -> [f64; 4] {
        let x = position / self.scale;
        // adj Σ = Σ_i k_i k_iᵀ with k_i at right angles to c_i.
        let weight = |c: &DVec2| *c * (c.perp_dot(x) / self.root_determinant);
        let sum: DVec2 = self.columns.iter().map(weight).sum();
        let solved = sum / self.root_determinant;
        self.columns.map(|c| solved.perp_dot(c))
    }

    /// Returns `xᵀ Σ⁻¹ x`.
    pub(super) fn squared_distance(&self, position: DVec2) -> f64 {
        let x = position / self.scale;
        let square = |c: &DVec2| (c.perp_dot(x) / self.root_determinant).powi(2);
        self.columns.iter().map(square).sum()
    }

    /// Returns the normal density on the axis, `1 / (2π √det Σ)`.
    pub(super) fn peak(&self) -> f64 {
        let [larger, smaller] = self.deviations();
        1.0 / (core::f64::consts::TAU * larger * smaller)
    }
}

/// Returns `Σ_i a_i b_iᵀ`.
pub(super) fn covariance(a: &[DVec2; 4], b: &[DVec2; 4]) -> DMat2 {
    let product = |(a, b): (&DVec2, &DVec2)| DMat2::from_cols(*a * b.x, *a * b.y);
    a.iter().zip(b).map(product).sum()
}

/// Returns the weighted sum of the columns.
pub(super) fn combine(columns: &[DVec2; 4], weights: [f64; 4]) -> DVec2 {
    columns.iter().zip(weights).map(|(c, w)| *c * w).sum()
}
