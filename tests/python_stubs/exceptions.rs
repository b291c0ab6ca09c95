//! What the signatures of Rust do not say.

use crate::types::Python;

/// Choices by name and functions as arguments, by the name of the parameter.
const ARGUMENTS: &[(&str, &str)] = &[
    ("axis", "Literal[\"x\", \"y\"]"),
    ("boundary", "Boundary"),
    ("correlation", "Callable[[float], float]"),
    ("cumulative", "Cumulative"),
    ("interpolation", "Interpolation"),
    ("patterns", "Iterable[SpecklePattern]"),
    ("phasors", "Phasors"),
    ("plans", "Sequence[StackPlan]"),
    ("purpose", "Purpose"),
];

/// Choices by name as results, by class and attribute.
const RESULTS: &[(&str, &str)] = &[
    ("FanGeometry.focus_curve", "FocusCurve"),
    (
        "Pupil.kind",
        "Literal[\"circle\", \"annulus\", \"rectangle\", \"gaussian\", \"sampled\"]",
    ),
    ("PupilField.phasors", "Phasors | None"),
    (
        "SlicePath.kind",
        "Literal[\"still\", \"circle\", \"straight\"]",
    ),
    ("SpeckleStack.interpolation", "Interpolation"),
    ("StackOptions.interpolation", "Interpolation"),
];

/// Methods whose result depends on their arguments in a way of its own, as they stand in the stub.
const METHODS: &[(&str, &str)] = &[
    (
        "Emitter.next_event",
        "    @overload
    def next_event(self, x: float, y: float, z: float) -> NextEvent | None: ...
    @overload
    def next_event(self, x: Numbers, y: Numbers, z: Numbers) -> NextEvent: ...
",
    ),
    (
        "Emitter.to_rows",
        "    def to_rows(self, dtype: Dtype = ...) -> NDArray[np.floating]: ...\n",
    ),
    (
        "PupilField.amplitude_correlation",
        "    @overload
    def amplitude_correlation(self, x: float, y: float) -> complex: ...
    @overload
    def amplitude_correlation(self, x: Numbers, y: Numbers) -> NDArray[np.complex128]: ...
",
    ),
    (
        "SpeckleFrame.amplitude",
        "    def amplitude(self, points: Vectors, normals: Vectors) -> complex | NDArray[np.complex128]: ...\n",
    ),
    (
        "SpeckleStack.amplitude_at",
        "    @overload
    def amplitude_at(self, x: float, y: float, u: float) -> complex: ...
    @overload
    def amplitude_at(self, x: Numbers, y: Numbers, u: Numbers) -> NDArray[np.complex128]: ...
",
    ),
];

/// The type of an argument.
pub(crate) fn argument(name: &str, ty: Python) -> Python {
    let unsaid = |text: &str| ["str", "PyAny"].iter().any(|word| text.contains(word));
    match (ty, ARGUMENTS.iter().find(|(own, _)| *own == name)) {
        (Python::One(text), Some((_, known))) if unsaid(&text) => {
            let none = if text.ends_with("| None") {
                " | None"
            } else {
                ""
            };
            Python::One(format!("{known}{none}"))
        }
        (ty, _) => ty,
    }
}

/// The type of an attribute.
pub(crate) fn attribute(class: &str, name: &str, ty: Python) -> Python {
    let full = format!("{class}.{name}");
    let known = RESULTS.iter().find(|(own, _)| *own == full);
    known.map_or(ty, |(_, text)| Python::One((*text).to_owned()))
}

/// A method as it stands in the stub.
pub(crate) fn method(class: &str, name: &str) -> Option<&'static str> {
    let full = format!("{class}.{name}");
    METHODS
        .iter()
        .find(|(own, _)| *own == full)
        .map(|(_, text)| *text)
}
