/// Horizontal axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Axis {
    /// Along the profile.
    X,
    /// Along the scan.
    Y,
}

/// Groove with upright walls.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Groove {
    /// The place of its middle along the axis, in metres.
    pub centre: f64,
    /// The distance of its walls, in metres.
    pub width: f64,
}

impl Groove {
    /// Returns the places of its walls, in metres.
    pub fn walls(&self) -> [f64; 2] {
        [-0.5, 0.5].map(|side| self.centre + side * self.width)
    }
}

/// Shape of an artefact; the highest point of its middle is the origin.
#[derive(Clone, Debug, PartialEq)]
pub enum Shape {
    /// The plane of these slopes.
    Flat {
        /// The slopes along x and y.
        slope: [f64; 2],
    },
    /// A plane z = 0 with grooves.
    Grooves {
        /// The axis that runs across the grooves.
        across: Axis,
        /// The depth of the grooves, in metres.
        depth: f64,
        /// The grooves, by their places, apart from each other.
        grooves: Vec<Groove>,
    },
    /// The upper half of a sphere.
    Sphere {
        /// The radius, in metres.
        radius: f64,
    },
}

/// Artefact whose shape is known.
#[derive(Clone, Debug, PartialEq)]
pub struct Artefact {
    /// The name by which reports call it.
    pub name: &'static str,
    /// The shape.
    pub shape: Shape,
    /// The lengths along x and y, in metres.
    pub size: [f64; 2],
}

impl Artefact {
    /// Returns the height at a place, in metres, or `None` outside of the artefact.
    pub fn height(&self, x: f64, y: f64) -> Option<f64> {
        let [half_x, half_y] = self.size.map(|side| 0.5 * side);
        if x.abs() > half_x || y.abs() > half_y {
            return None;
        }
        match &self.shape {
            Shape::Flat { slope } => Some(slope[0] * x + slope[1] * y),
            Shape::Grooves {
                across,
                depth,
                grooves,
            } => {
                let place = if *across == Axis::X { x } else { y };
                let inside = |groove: &Groove| 2.0 * (place - groove.centre).abs() < groove.width;
                Some(if grooves.iter().any(inside) {
                    -depth
                } else {
                    0.0
                })
            }
            Shape::Sphere { radius } => {
                let below = radius * radius - x * x - y * y;
                (below >= 0.0).then(|| below.sqrt() - radius)
            }
        }
    }

    /// Returns places along x and the heights there, including the highest and the lowest of a
    /// section along x.
    pub fn heights_along(&self, y: f64) -> impl Iterator<Item = (f64, f64)> {
        const PLACES: u32 = 33;
        let deepest = match self.shape {
            Shape::Grooves { depth, .. } => depth,
            Shape::Flat { .. } | Shape::Sphere { .. } => 0.0,
        };
        let places = (0..PLACES).filter_map(move |k| {
            let x = self.size[0] * (f64::from(k) / f64::from(PLACES - 1) - 0.5);
            Some((x, self.height(x, y)?))
        });
        places.flat_map(move |(x, height)| [(x, height), (x, height - deepest)])
    }
}
