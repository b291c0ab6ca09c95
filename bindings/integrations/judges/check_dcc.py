"""pydcc and dsiUnits judge the digital calibration certificate of a budget.

pydcc reads the certificate back, and every number must be that of the budget's JSON, in the SI unit
that dsiUnits finds in it. The schema of the Physikalisch-Technische Bundesanstalt is in no package,
and its servers cannot be asked offline: CHILDREN states, of the elements that certificates have,
what version 3.3.0 of the DCC with D-SI 2.2 allows.
"""

import json
import re
import sys
from pathlib import Path
from typing import Any
from unittest import mock
from xml.etree import ElementTree

from judge import FRAMES, ROOT, Verdict, run

# Signatures are not judged. Their package does not know OpenSSL from 3.0.10 on, and fails on
# import.
sys.modules["certvalidator"] = mock.MagicMock()

from dcc import DCC  # noqa: E402
from dsi_unit import DsiUnit  # noqa: E402

Record = dict[str, Any]

NAMESPACES = {"{https://ptb.de/dcc}": "dcc:", "{https://ptb.de/si}": "si:"}

# The children of elements in their order; those with `!` must be there, those with `+` more than
# once perhaps.
CHILDREN = {
    "dcc:digitalCalibrationCertificate": "dcc:administrativeData! dcc:measurementResults!",
    "dcc:administrativeData": "dcc:dccSoftware! dcc:coreData! dcc:items! "
    "dcc:calibrationLaboratory! dcc:respPersons! dcc:customer! dcc:statements",
    "dcc:dccSoftware": "dcc:software!+",
    "dcc:software": "dcc:name! dcc:release! dcc:type",
    "dcc:coreData": "dcc:countryCodeISO3166_1! dcc:usedLangCodeISO639_1!+ "
    "dcc:mandatoryLangCodeISO639_1!+ dcc:uniqueIdentifier! dcc:beginPerformanceDate! "
    "dcc:endPerformanceDate! dcc:performanceLocation! dcc:issueDate",
    "dcc:items": "dcc:item!+",
    "dcc:item": "dcc:name! dcc:manufacturer dcc:model dcc:identifications!",
    "dcc:identifications": "dcc:identification!+",
    "dcc:identification": "dcc:issuer! dcc:value!",
    "dcc:calibrationLaboratory": "dcc:contact!",
    "dcc:respPersons": "dcc:respPerson!+",
    "dcc:respPerson": "dcc:person! dcc:mainSigner",
    "dcc:contact": "dcc:name! dcc:eMail dcc:location!",
    "dcc:customer": "dcc:name! dcc:eMail dcc:location!",
    "dcc:person": "dcc:name!",
    "dcc:manufacturer": "dcc:name!",
    "dcc:location": "dcc:street dcc:postCode dcc:city! dcc:countryCode",
    "dcc:statements": "dcc:statement!+",
    "dcc:statement": "dcc:name dcc:declaration",
    "dcc:measurementResults": "dcc:measurementResult!+",
    "dcc:measurementResult": "dcc:name! dcc:usedMethods dcc:influenceConditions dcc:results!",
    "dcc:usedMethods": "dcc:usedMethod!+",
    "dcc:usedMethod": "dcc:name! dcc:description dcc:norm+",
    "dcc:influenceConditions": "dcc:influenceCondition!+",
    "dcc:influenceCondition": "dcc:name! dcc:data!",
    "dcc:results": "dcc:result!+",
    "dcc:result": "dcc:name! dcc:data!",
    "dcc:data": "dcc:quantity!+",
    "dcc:quantity": "dcc:name dcc:description si:real!",
    "dcc:name": "dcc:content!+",
    "dcc:description": "dcc:content!+",
    "dcc:declaration": "dcc:content!+",
    "si:real": "si:value! si:unit! si:measurementUncertaintyUnivariate",
    "si:measurementUncertaintyUnivariate": "si:standardMU si:expandedMU si:coverageIntervalMU",
    "si:standardMU": "si:valueStandardMU! si:distribution",
    "si:expandedMU": "si:valueExpandedMU! si:coverageFactor! si:coverageProbability! "
    "si:distribution",
    "si:coverageIntervalMU": "si:valueStandardMU! si:intervalMin! si:intervalMax! "
    "si:coverageProbability! si:distribution",
}
PATTERNS = {
    "dcc:countryCodeISO3166_1": "[A-Z]{2}",
    "dcc:countryCode": "[A-Z]{2}",
    "dcc:usedLangCodeISO639_1": "[a-z]{2}",
    "dcc:mandatoryLangCodeISO639_1": "[a-z]{2}",
    "dcc:beginPerformanceDate": r"\d{4}-\d\d-\d\d",
    "dcc:endPerformanceDate": r"\d{4}-\d\d-\d\d",
    "dcc:issueDate": r"\d{4}-\d\d-\d\d",
    "dcc:performanceLocation": "laboratory|customer|laboratoryBranch|customerBranch|other",
    "dcc:issuer": "manufacturer|calibrationLaboratory|customer|owner|other",
    "dcc:mainSigner": "true|false",
    "si:unit": r"(\\\S+)+",
    "si:distribution": r"\S+",
}
# Of the other texts: numbers in D-SI, and what is not empty.
NUMBER = r"[-+]?\d+(\.\d+)?([eE][-+]?\d+)?"
NOT_EMPTY = r"\S+(\s+\S+)*"

# The unit of a section's quantities that are no plain numbers, by the end of their keys.
UNITS = {
    r"\watt": ["power"],
    r"\kelvin": ["temperature_change"],
    r"\radian": ["angle", "tilt"],
    r"\metre": ["offset", "focal_length", "distance", "pixel_pitch", "calibration", "height"],
}


def short(tag: str) -> str:
    """Returns the name of an element with the usual prefix of its namespace."""
    for uri, prefix in NAMESPACES.items():
        if tag.startswith(uri):
            return tag.replace(uri, prefix)
    raise SystemExit(f"{tag} is in no namespace of certificates")


def check_schema(element: ElementTree.Element) -> int:
    """Checks an element and all in it; returns how many there are."""
    name = short(element.tag)
    children = [short(child.tag) for child in element]
    if name not in CHILDREN:
        pattern = PATTERNS.get(name, NUMBER if name.startswith("si:") else NOT_EMPTY)
        if children or not re.fullmatch(pattern, element.text or ""):
            raise SystemExit(f"{name} has {element.text!r} and {children}")
        return 1
    repeats = {"": "?", "!": "", "+": "*", "!+": "+"}
    allowed = re.findall(r"(\S+?)(!?\+?) ", CHILDREN[name] + " ")
    order = "".join(f"({child} ){repeats[mark]}" for child, mark in allowed)
    if not re.fullmatch(order, "".join(child + " " for child in children)):
        raise SystemExit(f"{name} has {children}, allowed are {CHILDREN[name]}")
    return 1 + sum(map(check_schema, element))


def certified(name: str, change: tuple[str, str]) -> tuple[DCC, Record, Path]:
    """Has the program certify the example set-up with a change; returns certificate and budget."""
    folder = FRAMES / name
    folder.mkdir(parents=True, exist_ok=True)
    text = (ROOT / "examples/setups/certified.toml").read_text()
    if change[0] not in text:
        raise SystemExit(f"the set-up has no {change[0]}")
    setup = folder / "setup.toml"
    setup.write_text(text.replace(*change))
    run("tem00-inspect", "budget", str(setup), "--trials", "0", "--output", str(folder))
    path = folder / "certificate.xml"
    # It would download the schema.
    with mock.patch("dcc.dcc.DCCXMLValidator"):
        certificate = DCC(str(path))
    return certificate, json.loads((folder / "budget.json").read_text())["measurement"], path


def by_name(certificate: DCC) -> dict[str, Any]:
    """Returns the quantities of the results by the last words of their names."""
    found = {}
    for name, value in certificate.get_calibration_results("name", "en"):
        key = re.sub("^.*(Measured height|standard uncertainties|of input quantities) ", "", name)
        found[key] = value["real"]
    return found


def check_unit(name: str, unit: str) -> None:
    """Checks that a unit is one of the D-SI, and of the kind that the input has."""
    expected = [unit for unit, keys in UNITS.items() if name.split(".")[-1] in keys] or [r"\one"]
    if not DsiUnit(unit).valid or DsiUnit(unit).get_scale_factor(DsiUnit(expected[0])) != 1.0:
        raise SystemExit(f"{name} is in {unit}, not in {expected[0]}")


def check(verdict: Verdict, quoted: str, change: tuple[str, str]) -> None:
    """Compares every number of a certificate with the budget."""
    certificate, ours, path = certified(f"certificate_{quoted}", change)
    if ours["quoted"] != quoted or certificate.version() != "3.3.0":
        raise SystemExit(
            f"{ours['quoted']} is quoted, not {quoted}; schema {certificate.version()}"
        )
    names = (
        certificate.uid(),
        certificate.calibration_laboratory_name(),
        f"{certificate.calibration_date():%F}",
    )
    if names != ("EX-2026-001", "Example laboratory for lengths", "2026-11-23"):
        raise SystemExit(f"other names: {names}")
    print(
        f"{quoted}: {check_schema(ElementTree.parse(path).getroot())} elements"
        " as the schema has them"
    )
    found = by_name(certificate)
    answer = next(row for row in ours["answers"] if row["method"] == quoted)
    pairs = of_height(found.pop("height"), answer) + of_inputs(found, ours["inputs"])
    for row in ours["correlations"]:
        pairs.append(
            ("correlation", found.pop(" and ".join(row["between"]))["value"], row["coefficient"])
        )
    if found:
        raise SystemExit(f"beside the budget: {list(found)}")
    for what, theirs, expected in pairs:
        deviation = float(theirs) - expected
        # Ends of intervals are rounded beside their half.
        verdict.within(f"{quoted}: {what} (relative)", deviation / (abs(expected) or 1.0), 1e-12)


def of_height(height: Record, answer: Record) -> list[tuple[str, str, float]]:
    """Returns the numbers of the height, each beside that of the budget."""
    check_unit("height", height["unit"])
    uncertainty = height["measurementUncertaintyUnivariate"]
    half = 0.5 * (answer["high"] - answer["low"])
    expected = {
        "valueExpandedMU": half,
        "coverageFactor": half / answer["uncertainty"],
        "valueStandardMU": answer["uncertainty"],
        "intervalMin": answer["low"],
        "intervalMax": answer["high"],
        "coverageProbability": 0.95,
    }
    kind = "expandedMU" if answer["method"] == "first_order" else "coverageIntervalMU"
    numbers = {key: value for key, value in uncertainty[kind].items() if key != "distribution"}
    return [("height", height["value"], answer["estimate"])] + [
        (key, numbers[key], expected[key]) for key in numbers
    ]


def of_inputs(found: Record, inputs: list[Record]) -> list[tuple[str, str, float]]:
    """Takes the inputs out of what was found; returns their numbers beside those of the budget."""
    pairs = []
    for row in inputs:
        theirs = found.pop(row["input"])
        check_unit(row["input"], theirs["unit"])
        standard = theirs["measurementUncertaintyUnivariate"]["standardMU"]
        if standard["distribution"] != row["distribution"]:
            raise SystemExit(f"{row['input']} is {standard['distribution']}")
        pairs.append((row["input"], theirs["value"], row["estimate"]))
        pairs.append((f"u of {row['input']}", standard["valueStandardMU"], row["uncertainty"]))
    return pairs


def main() -> None:
    """Has the program write certificates of both kinds, and compares."""
    verdict = Verdict()
    # Of so many readings that t is normal to two digits.
    check(verdict, "first_order", ("degrees_of_freedom = 8", "degrees_of_freedom = 60"))
    rectangular = '{ value = "30 deg", uncertainty = "0.2 deg", distribution = "rectangular" }'
    angle = '{ value = "30 deg", uncertainty = "0.05 deg", degrees_of_freedom = 8 }'
    check(verdict, "propagation", (angle, rectangular))
    verdict.end()


if __name__ == "__main__":
    main()
