//! The digital calibration certificate (DCC) of a budget.

mod data;
mod element;

use tem00_triangulation::{MeasurementInput, Setup, SetupQuantity};
use tem00_uncertainty::{CoverageProbability, Distribution, Input};

pub(super) use self::data::CertificateData;
use self::{data::Texts, element::Element};
use super::{
    answers::{source, verdicts},
    measured::{Quoted, ThreeMethods},
};

/// The version of the schema of the Physikalisch-Technische Bundesanstalt that certificates follow.
const SCHEMA: &str = "3.3.0";

/// Statement in every certificate.
const STATEMENT: &str = "This certificate states the calculated uncertainty budget of a \
    laser-triangulation set-up as its data sheets, certificates and tolerances describe it. It is \
    not the result of a measurement: no item was calibrated.";

/// Returns the certificate of a measured height as XML; the same input gives the same bytes.
pub(super) fn certificate(
    data: &CertificateData,
    measured: &ThreeMethods,
    setup: &Setup,
) -> String {
    let parts = [administrative(data), results(measured, setup)];
    Element::new("dcc:digitalCalibrationCertificate", parts)
        .with_attribute("schemaVersion", SCHEMA)
        .with_attribute("xmlns:dcc", "https://ptb.de/dcc")
        .with_attribute("xmlns:si", "https://ptb.de/si")
        .document()
}

/// Text in the language of the certificates.
fn words(element: &'static str, text: impl ToString) -> Element {
    Element::new(
        element,
        [Element::text("dcc:content", text).with_attribute("lang", "en")],
    )
}

fn administrative(data: &CertificateData) -> Element {
    let software = [
        words("dcc:name", "tem00"),
        Element::text("dcc:release", env!("CARGO_PKG_VERSION")),
        Element::text("dcc:type", "application"),
    ];
    let person = Element::new("dcc:person", worded("dcc:name", &data.own, "responsible"));
    let signer = [person, Element::text("dcc:mainSigner", true)];
    let laboratory = contact("dcc:contact", &data.laboratory);
    let statement = [
        words("dcc:name", "Kind of this certificate"),
        words("dcc:declaration", STATEMENT),
    ];
    let parts = [
        Element::new("dcc:dccSoftware", [Element::new("dcc:software", software)]),
        core_data(data),
        Element::new("dcc:items", [item(&data.item)]),
        Element::new("dcc:calibrationLaboratory", [laboratory]),
        Element::new("dcc:respPersons", [Element::new("dcc:respPerson", signer)]),
        contact("dcc:customer", &data.customer),
        Element::new("dcc:statements", [Element::new("dcc:statement", statement)]),
    ];
    Element::new("dcc:administrativeData", parts)
}

/// Returns an element with the text of a key, if it is there.
fn text(element: &'static str, texts: &Texts, key: &str) -> Option<Element> {
    Some(Element::text(element, texts.get(key)?))
}

/// Returns an element with the text of a key, in the language of the certificates.
fn worded(element: &'static str, texts: &Texts, key: &str) -> Option<Element> {
    Some(words(element, texts.get(key)?))
}

fn core_data(data: &CertificateData) -> Element {
    let own = |element, key| text(element, &data.own, key);
    let parts = [
        text("dcc:countryCodeISO3166_1", &data.laboratory, "country"),
        Some(Element::text("dcc:usedLangCodeISO639_1", "en")),
        Some(Element::text("dcc:mandatoryLangCodeISO639_1", "en")),
        own("dcc:uniqueIdentifier", "identifier"),
        own("dcc:beginPerformanceDate", "performed_from"),
        own("dcc:endPerformanceDate", "performed_to"),
        own("dcc:performanceLocation", "performed_at"),
        own("dcc:issueDate", "issued"),
    ];
    Element::new("dcc:coreData", parts.into_iter().flatten())
}

fn contact(element: &'static str, contact: &Texts) -> Element {
    let location = [
        ("dcc:street", "street"),
        ("dcc:postCode", "post_code"),
        ("dcc:city", "city"),
        ("dcc:countryCode", "country"),
    ];
    let location = location
        .into_iter()
        .filter_map(|(name, key)| text(name, contact, key));
    let parts = [
        worded("dcc:name", contact, "name"),
        text("dcc:eMail", contact, "email"),
        Some(Element::new("dcc:location", location)),
    ];
    Element::new(element, parts.into_iter().flatten())
}

fn item(item: &Texts) -> Element {
    let manufacturer = worded("dcc:name", item, "manufacturer");
    let identification = [("dcc:issuer", "issuer"), ("dcc:value", "identification")];
    let identification = identification
        .into_iter()
        .filter_map(|(name, key)| text(name, item, key));
    let identification = Element::new("dcc:identification", identification);
    let parts = [
        worded("dcc:name", item, "name"),
        manufacturer.map(|name| Element::new("dcc:manufacturer", [name])),
        text("dcc:model", item, "model"),
        Some(Element::new("dcc:identifications", [identification])),
    ];
    Element::new("dcc:item", parts.into_iter().flatten())
}

fn results(measured: &ThreeMethods, setup: &Setup) -> Element {
    let mut parts = vec![
        words("dcc:name", "Uncertainty of a measured height"),
        methods(measured),
    ];
    parts.extend(influence(measured, setup));
    parts.push(Element::new("dcc:results", all_results(measured)));
    let result = Element::new("dcc:measurementResult", parts);
    Element::new("dcc:measurementResults", [result])
}

fn methods(measured: &ThreeMethods) -> Element {
    let quoted = measured.quoted();
    let norms = match quoted {
        Quoted::FirstOrder => &["JCGM 100:2008", "JCGM 101:2008"][..],
        Quoted::Propagation => &["JCGM 101:2008"],
        Quoted::VirtualExperiment => &[],
    };
    let what = match quoted {
        Quoted::VirtualExperiment => {
            "Trials draw the true set-up, expose frames, find the line and evaluate the height \
             with the set-up as it is described."
        }
        _ => {
            "The height at which the line of sight meets the plane of the laser, by the inputs \
             that are listed."
        }
    };
    let mut parts = vec![
        words("dcc:name", quoted.name()),
        words(
            "dcc:description",
            format!("{what} {}", verdicts(measured).join(" ")),
        ),
    ];
    parts.extend(norms.iter().map(|norm| Element::text("dcc:norm", norm)));
    Element::new("dcc:usedMethods", [Element::new("dcc:usedMethod", parts)])
}

/// The change of temperature since the calibration, where the set-up states one.
fn influence(measured: &ThreeMethods, setup: &Setup) -> Option<Element> {
    let quantity = SetupQuantity::TemperatureChange;
    let change = MeasurementInput::Quantity(quantity);
    let known = measured.inputs().find(|(source, _)| *source == change);
    let data = match (known, quantity.value_in(setup.description())) {
        (Some((_, known)), _) => input(change, known),
        (None, 0.0) => return None,
        (None, exact) => self::quantity(
            words("dcc:name", quantity),
            None,
            exact,
            change.unit().d_si,
            None,
        ),
    };
    let name = "Change of temperature since the calibration";
    let condition = [words("dcc:name", name), Element::new("dcc:data", [data])];
    let condition = Element::new("dcc:influenceCondition", condition);
    Some(Element::new("dcc:influenceConditions", [condition]))
}

fn all_results(measured: &ThreeMethods) -> Vec<Element> {
    let inputs = measured
        .inputs()
        .map(|(source, known)| input(source, known))
        .collect();
    let mut all = vec![
        result("Measured height", vec![height(measured)]),
        result("Input quantities with their standard uncertainties", inputs),
    ];
    let correlations = measured
        .correlations()
        .map(|([first, second], coefficient)| {
            let pair = format!("{} and {}", source(first), source(second));
            quantity(words("dcc:name", pair), None, coefficient, "\\one", None)
        });
    let correlations: Vec<Element> = correlations.collect();
    if !correlations.is_empty() {
        all.push(result(
            "Correlation coefficients of input quantities",
            correlations,
        ));
    }
    all
}

fn result(name: &str, quantities: Vec<Element>) -> Element {
    Element::new(
        "dcc:result",
        [
            words("dcc:name", name),
            Element::new("dcc:data", quantities),
        ],
    )
}

fn quantity(
    name: Element,
    description: Option<String>,
    value: f64,
    unit: &str,
    uncertainty: Option<Element>,
) -> Element {
    let uncertainty =
        uncertainty.map(|kind| Element::new("si:measurementUncertaintyUnivariate", [kind]));
    let real = [
        Element::text("si:value", value),
        Element::text("si:unit", unit),
    ];
    let real = Element::new("si:real", real.into_iter().chain(uncertainty));
    let description = description.map(|text| words("dcc:description", text));
    Element::new(
        "dcc:quantity",
        [name].into_iter().chain(description).chain([real]),
    )
}

/// The height with the uncertainty of the method that is to be quoted.
fn height(measured: &ThreeMethods) -> Element {
    let probability = CoverageProbability::P95;
    let (quoted, answer) = (measured.quoted(), measured.quoted_answer());
    let uncertainty = match quoted {
        Quoted::FirstOrder => {
            let expanded = measured.first_order.expanded(probability);
            let is_normal = measured.first_order.degrees_of_freedom().is_infinite();
            let shape = if is_normal {
                Distribution::Normal
            } else {
                Distribution::StudentT
            };
            let parts = [
                Element::text("si:valueExpandedMU", expanded),
                Element::text("si:coverageFactor", expanded / answer.uncertainty),
                Element::text("si:coverageProbability", probability.value()),
                Element::text("si:distribution", shape.name()),
            ];
            Element::new("si:expandedMU", parts)
        }
        Quoted::Propagation | Quoted::VirtualExperiment => {
            let parts = [
                ("si:valueStandardMU", answer.uncertainty),
                ("si:intervalMin", answer.interval.low),
                ("si:intervalMax", answer.interval.high),
                ("si:coverageProbability", probability.value()),
            ];
            let parts = parts.map(|(name, value)| Element::text(name, value));
            Element::new("si:coverageIntervalMU", parts)
        }
    };
    let name = words("dcc:name", "height");
    quantity(name, None, answer.estimate, "\\metre", Some(uncertainty))
}

fn input(of: MeasurementInput, known: &Input) -> Element {
    let unit = of.unit();
    let freedom = known.degrees_of_freedom();
    let freedom = freedom
        .is_finite()
        .then(|| format!("{freedom} degrees of freedom"));
    let notes: Vec<String> = unit
        .counted
        .map(str::to_owned)
        .into_iter()
        .chain(freedom)
        .collect();
    let uncertainty = [
        Element::text("si:valueStandardMU", known.uncertainty()),
        Element::text("si:distribution", known.distribution().name()),
    ];
    quantity(
        words("dcc:name", source(of)),
        (!notes.is_empty()).then(|| notes.join(", ")),
        known.estimate(),
        unit.d_si,
        Some(Element::new("si:standardMU", uncertainty)),
    )
}
