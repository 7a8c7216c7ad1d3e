//! The units of length that IGES knows: flag, name, size (IGES 5.3, 2.2.4.3.14 and .15).

use std::str::FromStr;

use crate::scene::records::LengthUnit;

/// A unit of length.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Unit {
    /// Flag in the global section.
    pub flag: i64,
    /// Short name as shown to users.
    pub name: &'static str,
    /// Millimetres in one unit.
    pub millimetres: f64,
    /// Names in files, the standard's own first.
    names: &'static [&'static str],
}

const fn unit(flag: i64, name: &'static str, millimetres: f64, names: &'static [&'static str]) -> Unit {
    Unit { flag, name, millimetres, names }
}

/// All units.
pub const UNITS: [Unit; 10] = [
    unit(1, "in", 25.4, &["IN", "INCH", "INCHES"]),
    unit(2, "mm", 1.0, &["MM", "MILLIMETER", "MILLIMETERS", "MILLIMETRE"]),
    unit(4, "ft", 304.8, &["FT", "FOOT", "FEET"]),
    unit(5, "mi", 1_609_344.0, &["MI", "MILE", "MILES"]),
    unit(6, "m", 1000.0, &["M", "METER", "METERS", "METRE"]),
    unit(7, "km", 1e6, &["KM", "KILOMETER", "KILOMETERS", "KILOMETRE"]),
    unit(8, "mil", 0.0254, &["MIL", "MILS"]),
    unit(9, "um", 1e-3, &["UM", "MICRON", "MICRONS", "MICROMETER"]),
    unit(10, "cm", 10.0, &["CM", "CENTIMETER", "CENTIMETERS", "CENTIMETRE"]),
    unit(11, "uin", 2.54e-5, &["UIN", "MICROINCH", "MICROINCHES"]),
];

impl Unit {
    /// Millimetres.
    pub const MILLIMETRE: Self = UNITS[1];

    /// The unit of a flag.
    pub fn by_flag(flag: i64) -> Option<Self> {
        UNITS.into_iter().find(|u| u.flag == flag)
    }

    /// The unit of a name as files write it.
    pub fn by_name(name: &str) -> Option<Self> {
        let upper = name.trim().to_ascii_uppercase();
        UNITS.into_iter().find(|u| u.names.contains(&upper.as_str()))
    }

    /// The standard's own name.
    pub fn file_name(&self) -> &'static str {
        self.names[0]
    }
}

impl From<Unit> for LengthUnit {
    fn from(unit: Unit) -> Self {
        Self { name: unit.name.into(), millimetres: unit.millimetres }
    }
}

impl FromStr for Unit {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        Self::by_name(text).ok_or_else(|| format!("expected one of {}", UNITS.map(|u| u.name).join(", ")))
    }
}

/// The unit for a flag and a name; the flag wins, except where it says "see the name". Also what is wrong
/// with them.
pub(crate) fn choose(flag: i64, name: &str) -> (LengthUnit, Option<String>) {
    match (Unit::by_flag(flag), Unit::by_name(name)) {
        (Some(a), Some(b)) if a.flag != b.flag => {
            let problem =
                format!("unit flag {flag} says {}, unit name says {name}; {} is used", a.name, a.name);
            (a.into(), Some(problem))
        }
        (Some(a), _) => (a.into(), None),
        (None, Some(b)) => {
            let problem =
                (flag != 3 && flag != 0).then(|| format!("unknown unit flag {flag}; {name} is used"));
            (b.into(), problem)
        }
        // With no unit at all IGES means inches.
        (None, None) if flag == 0 && name.trim().is_empty() => (UNITS[0].into(), None),
        (None, None) => {
            (LengthUnit::default(), Some(format!("unknown unit (flag {flag}, name `{name}`); mm is used")))
        }
    }
}
