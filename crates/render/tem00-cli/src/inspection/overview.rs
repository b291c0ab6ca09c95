//! Camera, lasers and parts, seen along the three axes.

use glam::{DVec2, DVec3};
use kuva::render::{
    color::Color,
    render::{PathData, Primitive, Scene as Canvas, TextAnchor},
};
use tem00_camera::Camera;
use tem00_engine::LaserInspection;
use tem00_geometry::Shape;
use tem00_report::plot::Drawing;
use tem00_tracer::Scene;

/// The side of a view, and the margin around it, in units of the drawing.
const SIDE: f64 = 380.0;
const MARGIN: f64 = 24.0;
/// The room for the title above, and for the scale below.
const TITLE: f64 = 28.0;
const SCALE: f64 = 36.0;
/// The number of corners in the outline of a round shape.
const ROUND: u32 = 72;
/// The maximum number of surfaces that are named.
const MAX_NAMES: usize = 24;

const PART: &str = "#808080";
const CAMERA: &str = "#1f5fa8";
const LIGHT: &str = "#d2a01a";
const LASERS: [&str; 4] = ["#c02030", "#2a8a5a", "#7a4fa0", "#d2701a"];

/// A direction to look along.
struct View {
    title: &'static str,
    right: DVec3,
    up: DVec3,
}

const VIEWS: [View; 3] = [
    View::new("from +z: x to the right, y up", DVec3::X, DVec3::Y),
    View::new("from −x: z to the right, y up", DVec3::Z, DVec3::Y),
    View::new("from +y: x to the right, z down", DVec3::X, DVec3::NEG_Z),
];

impl View {
    const fn new(title: &'static str, right: DVec3, up: DVec3) -> Self {
        Self { title, right, up }
    }

    fn of(&self, point: DVec3) -> DVec2 {
        DVec2::new(point.dot(self.right), point.dot(self.up))
    }
}

/// Draws a scene as it stands in a frame, with the light paths of its lasers.
pub(super) fn draw(scene: &Scene, frame: u32, lasers: &[LaserInspection]) -> Drawing {
    let content = Content {
        scene,
        camera: scene.camera_at(frame),
        shapes: scene.shapes_at(frame),
        lasers,
    };
    let views: Vec<_> = VIEWS
        .iter()
        .map(|view| (view, content.extent(view)))
        .collect();
    let largest = |(_, (low, high)): &(&View, (DVec2, DVec2))| (*high - *low).max_element();
    let extent = views.iter().map(largest).fold(1e-9, f64::max);
    let height = TITLE + SIDE + SCALE;
    let mut canvas = Canvas::new(3.0 * SIDE, height);
    for (column, (view, (low, high))) in (0_u32..).zip(&views) {
        let panel = Panel {
            view,
            middle: 0.5 * (*low + *high),
            left: f64::from(column) * SIDE,
            per_metre: (SIDE - 2.0 * MARGIN) / extent,
        };
        content.draw(&panel, &mut canvas);
    }
    draw_scale(extent, &mut canvas);
    Drawing::of_scene(canvas)
}

/// The objects of the drawing.
struct Content<'a> {
    scene: &'a Scene,
    camera: Camera,
    /// The surfaces, then the area lights.
    shapes: Vec<Shape>,
    lasers: &'a [LaserInspection],
}

impl Content<'_> {
    /// Returns the lowest and the highest corner of all objects in a view.
    fn extent(&self, view: &View) -> (DVec2, DVec2) {
        let parts = self.shapes.iter().flat_map(|shape| outline(shape, view));
        let points = parts
            .chain(self.lasers.iter().filter_map(aperture).map(|p| view.of(p)))
            .chain(pyramid(&self.camera).map(|p| view.of(p)));
        let nothing = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        points.fold(nothing, |(low, high), p| (low.min(p), high.max(p)))
    }

    fn draw(&self, panel: &Panel<'_>, canvas: &mut Canvas) {
        let title = panel.left + 0.5 * SIDE;
        canvas.add(text(panel.view.title, title, 18.0, 13, "#202020"));
        for (index, shape) in self.shapes.iter().enumerate() {
            let is_part = index < self.scene.surfaces.len();
            let colour = if is_part { PART } else { LIGHT };
            panel.area(&outline(shape, panel.view), colour, canvas);
        }
        for (index, laser) in self.lasers.iter().enumerate() {
            self.draw_laser(index, laser, panel, canvas);
        }
        self.draw_camera(panel, canvas);
        if self.scene.surfaces.len() <= MAX_NAMES {
            for (surface, shape) in self.scene.surfaces.iter().zip(&self.shapes) {
                let corners = outline(shape, panel.view);
                let top = corners.into_iter().max_by(|a, b| a.y.total_cmp(&b.y));
                panel.label(&surface.name, top.unwrap_or_default(), PART, canvas);
            }
        }
    }

    fn draw_laser(
        &self,
        index: usize,
        laser: &LaserInspection,
        panel: &Panel<'_>,
        canvas: &mut Canvas,
    ) {
        let colour = LASERS[index % LASERS.len()];
        for way in &laser.ways {
            for leg in way.windows(2) {
                let ends = [leg[0], leg[1]].map(|p| panel.view.of(p));
                panel.line(ends, 0.5, colour, canvas);
            }
        }
        if let Some(aperture) = aperture(laser) {
            let name = format!("laser {index}");
            panel.label(&name, panel.view.of(aperture), colour, canvas);
        }
    }

    fn draw_camera(&self, panel: &Panel<'_>, canvas: &mut Canvas) {
        let [eye, corners @ ..] = pyramid(&self.camera).map(|p| panel.view.of(p));
        for (index, &corner) in corners.iter().enumerate() {
            panel.line([eye, corner], 0.8, CAMERA, canvas);
            panel.line([corner, corners[(index + 1) % 4]], 1.4, CAMERA, canvas);
        }
        panel.label("camera", eye, CAMERA, canvas);
    }
}

/// The position of a view in the drawing.
struct Panel<'a> {
    view: &'a View,
    /// The point in the middle, in metres.
    middle: DVec2,
    left: f64,
    per_metre: f64,
}

impl Panel<'_> {
    fn place(&self, point: DVec2) -> DVec2 {
        let offset = self.per_metre * (point - self.middle);
        let middle = DVec2::new(self.left + 0.5 * SIDE, TITLE + 0.5 * SIDE);
        middle + DVec2::new(offset.x, -offset.y)
    }

    fn area(&self, corners: &[DVec2], colour: &str, canvas: &mut Canvas) {
        let places = corners.iter().map(|&corner| self.place(corner));
        let steps: Vec<_> = places
            .map(|at| format!("{:.2} {:.2} ", at.x, at.y))
            .collect();
        canvas.add(Primitive::Path(Box::new(PathData {
            d: format!("M {}Z", steps.join("L ")),
            fill: Some(Color::from("#e8e8e8")),
            stroke: Color::from(colour),
            stroke_width: 1.0,
            opacity: Some(0.7),
            stroke_dasharray: None,
        })));
    }

    /// Draws the part of a line that lies in the panel.
    fn line(&self, ends: [DVec2; 2], width: f64, colour: &str, canvas: &mut Canvas) {
        let low = DVec2::new(self.left, TITLE);
        let ends = clipped(ends.map(|p| self.place(p)), [low, low + SIDE]);
        if let Some(ends) = ends {
            canvas.add(stroke(ends, width, colour));
        }
    }

    fn label(&self, name: &str, at: DVec2, colour: &str, canvas: &mut Canvas) {
        let DVec2 { x, y } = self.place(at);
        canvas.add(text(name, x, y - 4.0, 11, colour));
    }
}

fn stroke([from, to]: [DVec2; 2], stroke_width: f64, colour: &str) -> Primitive {
    Primitive::Line {
        x1: from.x,
        y1: from.y,
        x2: to.x,
        y2: to.y,
        stroke: Color::from(colour),
        stroke_width,
        stroke_dasharray: None,
    }
}

fn text(content: &str, x: f64, y: f64, size: u32, colour: &str) -> Primitive {
    Primitive::Text {
        x,
        y,
        content: content.to_owned(),
        size,
        anchor: TextAnchor::Middle,
        rotate: None,
        bold: false,
        color: Some(Color::from(colour)),
    }
}

/// Draws a length of 1, 2 or 5 times a power of ten, about a fifth of the view.
fn draw_scale(extent: f64, canvas: &mut Canvas) {
    let decade = 10.0_f64.powf((0.2 * extent).log10().floor());
    let fits = |step: &f64| step * decade <= 0.2 * extent;
    let length = decade * [5.0, 2.0].into_iter().find(fits).unwrap_or(1.0);
    let width = length * (SIDE - 2.0 * MARGIN) / extent;
    let y = TITLE + SIDE + 8.0;
    let ends = [MARGIN, MARGIN + width].map(|x| DVec2::new(x, y));
    canvas.add(stroke(ends, 2.0, "#202020"));
    let name = format!("{} mm", tem00_report::digits::rounded(1e3 * length, 3));
    canvas.add(text(&name, MARGIN + 0.5 * width, y + 16.0, 12, "#202020"));
}

fn aperture(laser: &LaserInspection) -> Option<DVec3> {
    let way = laser.ways.first()?;
    way.first().copied()
}

/// Returns the position of the camera and the corners of its field of view at the focus distance,
/// in metres.
fn pyramid(camera: &Camera) -> [DVec3; 5] {
    let [width, height] = [camera.width(), camera.height()].map(|pixels| pixels as f64);
    let distance = camera.description().focus_distance;
    let corner = |x: f64, y: f64| {
        let ray = camera.ray(DVec2::new(x, y));
        let depth = -ray.direction.dot(camera.axes().z_axis);
        ray.origin + distance / depth * ray.direction
    };
    [
        camera.position(),
        corner(0.0, 0.0),
        corner(width, 0.0),
        corner(width, height),
        corner(0.0, height),
    ]
}

/// Returns the corners of the convex outline of a shape in a view, in order, in metres.
fn outline(shape: &Shape, view: &View) -> Vec<DVec2> {
    let circle = |centre: DVec3, [a, b]: [DVec3; 2]| {
        (0..ROUND).map(move |i| {
            let (sin, cos) = (core::f64::consts::TAU * f64::from(i) / f64::from(ROUND)).sin_cos();
            view.of(centre + cos * a + sin * b)
        })
    };
    let points: Vec<DVec2> = match shape {
        Shape::Rectangle(rectangle) => [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)]
            .map(|(u, v)| view.of(rectangle.point(u, v)))
            .into(),
        Shape::Sphere(sphere) => {
            let axes = [view.right, view.up].map(|axis| sphere.radius() * axis);
            circle(sphere.centre(), axes).collect()
        }
        Shape::Cylinder(tube) => {
            let half = 0.5 * tube.length() * tube.axis();
            let (a, b) = tube.axis().any_orthonormal_pair();
            let axes = [a, b].map(|axis| tube.radius() * axis);
            let ends = [-half, half].map(|half| circle(tube.centre() + half, axes));
            ends.into_iter().flatten().collect()
        }
        Shape::Mesh(instance) => {
            let vertices = instance.mesh().vertices().iter();
            vertices.map(|&v| view.of(instance.point(v))).collect()
        }
    };
    convex_hull(points)
}

/// Returns the corners of the convex hull of points, in order.
///
/// # References
///
/// - A. M. Andrew, *Another Efficient Algorithm for Convex Hulls in Two Dimensions*, 1979.
fn convex_hull(mut points: Vec<DVec2>) -> Vec<DVec2> {
    points.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
    let chain = |points: &mut dyn Iterator<Item = DVec2>| {
        let mut chain: Vec<DVec2> = Vec::new();
        for point in points {
            while let [.., before, last] = chain[..]
                && (last - before).perp_dot(point - last) <= 0.0
            {
                chain.pop();
            }
            chain.push(point);
        }
        chain.pop();
        chain
    };
    let mut hull = chain(&mut points.iter().copied());
    hull.extend(chain(&mut points.iter().rev().copied()));
    hull
}

/// Returns the part of a line within a box, if any.
///
/// # References
///
/// - Y.-D. Liang and B. A. Barsky, *A New Concept and Method for Line Clipping*, 1984.
fn clipped([from, to]: [DVec2; 2], [low, high]: [DVec2; 2]) -> Option<[DVec2; 2]> {
    let way = to - from;
    let (mut enter, mut leave) = (0.0_f64, 1.0_f64);
    for axis in 0..2 {
        let [a, b] = [low[axis] - from[axis], high[axis] - from[axis]];
        if way[axis] == 0.0 {
            if a > 0.0 || b < 0.0 {
                return None;
            }
            continue;
        }
        let [near, far] = [a / way[axis], b / way[axis]];
        enter = enter.max(near.min(far));
        leave = leave.min(near.max(far));
    }
    (enter <= leave).then(|| [from + enter * way, from + leave * way])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_hull_has_the_corners_alone() {
        let points = [
            (0.0, 0.0),
            (2.0, 0.0),
            (1.0, 1.0),
            (2.0, 2.0),
            (0.0, 2.0),
            (1.0, 0.0),
        ];
        let hull = convex_hull(points.map(DVec2::from).into());
        let corners = [(0.0, 0.0), (2.0, 0.0), (2.0, 2.0), (0.0, 2.0)];
        assert_eq!(hull, corners.map(DVec2::from));
        assert!(convex_hull(Vec::new()).is_empty(), "nothing");
    }

    #[test]
    fn lines_end_at_the_box() {
        let within = |from: (f64, f64), to: (f64, f64)| {
            let found = clipped([from.into(), to.into()], [DVec2::ZERO, DVec2::splat(10.0)]);
            found.map(|ends| ends.map(|p| (p.x, p.y)))
        };
        for (from, to, ends) in [
            ((2.0, 5.0), (20.0, 5.0), [(2.0, 5.0), (10.0, 5.0)]),
            ((-5.0, -5.0), (15.0, 15.0), [(0.0, 0.0), (10.0, 10.0)]),
            ((1.0, 1.0), (2.0, 3.0), [(1.0, 1.0), (2.0, 3.0)]),
        ] {
            assert_eq!(within(from, to), Some(ends));
        }
        assert_eq!(within((-5.0, 12.0), (15.0, 12.0)), None);
        assert_eq!(within((-1.0, 9.0), (3.0, 15.0)), None);
    }
}
