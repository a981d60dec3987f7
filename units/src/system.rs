//! The coherent system of units in which a model computes.

use std::cmp::Reverse;
use std::fmt;

use crate::dimension::{BASE_NAMES, BASES};
use crate::product::product;
use crate::{Dimension, Rational, Scale, Unit, convert};

/// Six independent units; every other unit of the system is a product of their powers with factor 1.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct UnitSystem {
    units: [&'static Unit; BASES],
    /// Exponents of the units in each base quantity, `base x unit`.
    bases: [[Rational; BASES]; BASES],
}

/// Why declared units make no system.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum UnitSystemError {
    /// A symbol that is no unit.
    Unknown {
        /// Index among the declared units.
        index: usize,
        /// The symbol.
        symbol: String,
    },
    /// A unit of plain numbers, such as `deg`.
    Number {
        /// Index among the declared units.
        index: usize,
        /// The symbol.
        symbol: &'static str,
    },
    /// A unit that is already a product of those before it.
    Redundant {
        /// Index among the declared units.
        index: usize,
        /// The symbol.
        symbol: &'static str,
    },
    /// A unit that differs from the product of those before it that measures the same.
    Contradiction {
        /// Index among the declared units.
        index: usize,
        /// The symbol.
        symbol: &'static str,
        /// What the units before it give for the same dimension.
        instead: String,
    },
    /// Base quantities that the units involve but do not fix.
    Insufficient {
        /// Names of the base quantities.
        missing: Vec<&'static str>,
    },
}

impl UnitSystem {
    /// The system of the declared units, such as `um`, `s`, `nN`; base quantities that none of them involves keep
    /// their SI units.
    ///
    /// # Errors
    /// If a unit is unknown or one of plain numbers, depends on those before it, or if the units leave a base quantity
    /// open that they involve: `mm`, `N` fix neither mass nor time.
    pub fn new(symbols: &[&str]) -> Result<UnitSystem, UnitSystemError> {
        let mut basis = Basis::default();
        for (index, symbol) in symbols.iter().enumerate() {
            let unit = Unit::find(symbol)
                .ok_or_else(|| UnitSystemError::Unknown { index, symbol: (*symbol).to_owned() })?;
            basis.declare(index, unit)?;
        }
        basis.complete()
    }

    /// The size in SI units of the unit of a dimension, exactly.
    pub fn exact_scale(&self, dimension: Dimension) -> Scale {
        let powers = self.units.iter().zip(self.exponents(dimension));
        powers.fold(Scale::ONE, |scale, (unit, exponent)| scale * unit.scale.pow(exponent))
    }

    /// The SI value of one unit of this system for a dimension.
    pub fn scale(&self, dimension: Dimension) -> f64 {
        self.exact_scale(dimension).value()
    }

    /// The measure in this system of an SI value.
    pub fn to_internal(&self, si: f64, dimension: Dimension) -> f64 {
        convert(si, Scale::ONE, self.exact_scale(dimension))
    }

    /// The SI value of a measure in this system.
    pub fn from_internal(&self, value: f64, dimension: Dimension) -> f64 {
        convert(value, self.exact_scale(dimension), Scale::ONE)
    }

    /// The unit of a dimension as a product of the declared units, such as `nN/um^2`; composite units come first.
    pub fn unit_of(&self, dimension: Dimension) -> String {
        let mut factors: Vec<_> = self.units.iter().zip(self.exponents(dimension)).collect();
        let bases = |unit: &Unit| unit.dimension.exponents().iter().filter(|e| !e.is_zero()).count();
        factors.sort_by_key(|(unit, _)| Reverse(bases(unit)));
        product(factors.into_iter().map(|(unit, exponent)| (unit.symbol, exponent)))
    }

    /// Exponents of the units in a dimension.
    fn exponents(&self, dimension: Dimension) -> [Rational; BASES] {
        std::array::from_fn(|unit| {
            let terms = dimension.exponents().iter().zip(&self.bases);
            terms.fold(Rational::ZERO, |sum, (exponent, base)| sum + *exponent * base[unit])
        })
    }
}

/// SI: m, kg, s, K, mol and A.
impl Default for UnitSystem {
    fn default() -> UnitSystem {
        let identity = |row| std::array::from_fn(|column| Rational::integer(i32::from(row == column)));
        UnitSystem { units: SI, bases: std::array::from_fn(identity) }
    }
}

/// The SI unit of each base quantity.
const SI: [&Unit; BASES] = {
    const fn si(symbol: &'static str, dimension: Dimension) -> Unit {
        Unit { symbol, dimension, scale: Scale::ONE }
    }
    [
        &si("m", Dimension::LENGTH),
        &si("kg", Dimension::MASS),
        &si("s", Dimension::TIME),
        &si("K", Dimension::TEMPERATURE),
        &si("mol", Dimension::AMOUNT),
        &si("A", Dimension::CURRENT),
    ]
};

/// Independent units, solved for the base quantities by Gauss-Jordan elimination on their exponents.
#[derive(Default)]
struct Basis {
    units: Vec<&'static Unit>,
    rows: Vec<Row>,
}

/// One equation of the elimination: a product of powers of the units and the exponents of its dimension, which are 1
/// at `pivot` and 0 at the pivots of the other rows.
struct Row {
    pivot: usize,
    dimension: [Rational; BASES],
    units: [Rational; BASES],
}

impl Row {
    /// Divides by `other` to the power that cancels its pivot.
    fn eliminate(&mut self, other: &Row) {
        let exponent = self.dimension[other.pivot];
        for k in 0..BASES {
            self.dimension[k] = self.dimension[k] - exponent * other.dimension[k];
            self.units[k] = self.units[k] - exponent * other.units[k];
        }
    }
}

impl Basis {
    /// Adds a declared unit, which must be independent of those before it.
    fn declare(&mut self, index: usize, unit: &'static Unit) -> Result<(), UnitSystemError> {
        let symbol = unit.symbol;
        if unit.dimension.is_number() {
            return Err(UnitSystemError::Number { index, symbol });
        }
        let mut dependence = [Rational::ZERO; BASES];
        if self.insert(unit, &mut dependence) {
            return Ok(());
        }
        let powers = || self.units.iter().zip(dependence);
        let scale = powers().fold(Scale::ONE, |scale, (unit, e)| scale * unit.scale.pow(e));
        if scale == unit.scale {
            return Err(UnitSystemError::Redundant { index, symbol });
        }
        let instead = product(powers().map(|(unit, e)| (unit.symbol, e)));
        Err(UnitSystemError::Contradiction { index, symbol, instead })
    }

    /// Adds a unit if it is independent of the others; else writes into `dependence` the powers of the others that
    /// have its dimension.
    fn insert(&mut self, unit: &'static Unit, dependence: &mut [Rational; BASES]) -> bool {
        let mut row =
            Row { pivot: 0, dimension: *unit.dimension.exponents(), units: [Rational::ZERO; BASES] };
        for other in &self.rows {
            row.eliminate(other);
        }
        let Some(pivot) = row.dimension.iter().position(|exponent| !exponent.is_zero()) else {
            *dependence = row.units.map(|exponent| -exponent);
            return false;
        };
        row.pivot = pivot;
        row.units[self.units.len()] = Rational::ONE;
        let leading = row.dimension[pivot];
        row.dimension = row.dimension.map(|exponent| exponent / leading);
        row.units = row.units.map(|exponent| exponent / leading);
        for other in &mut self.rows {
            other.eliminate(&row);
        }
        self.units.push(unit);
        self.rows.push(row);
        true
    }

    /// The system, with the SI unit of each base quantity that no unit involves.
    fn complete(mut self) -> Result<UnitSystem, UnitSystemError> {
        let involved =
            |base: usize| self.units.iter().any(|unit| !unit.dimension.exponents()[base].is_zero());
        let fixed = |base: usize| {
            self.rows.iter().any(|row| {
                row.pivot == base && row.dimension.iter().filter(|exponent| !exponent.is_zero()).count() == 1
            })
        };
        let missing: Vec<_> =
            (0..BASES).filter(|&base| involved(base) && !fixed(base)).map(|base| BASE_NAMES[base]).collect();
        if !missing.is_empty() {
            return Err(UnitSystemError::Insufficient { missing });
        }
        let free: Vec<_> = (0..BASES).filter(|&base| !involved(base)).collect();
        for base in free {
            self.insert(SI[base], &mut [Rational::ZERO; BASES]);
        }
        // Now every base quantity is the pivot of one row, so there are as many units.
        let mut system = UnitSystem::default();
        system.units.copy_from_slice(&self.units);
        for row in self.rows {
            system.bases[row.pivot] = row.units;
        }
        Ok(system)
    }
}

impl fmt::Display for UnitSystemError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            UnitSystemError::Unknown { symbol, .. } => write!(f, "unknown unit `{symbol}`"),
            UnitSystemError::Number { symbol, .. } => {
                write!(f, "`{symbol}` counts plain numbers, which need no unit in a system")
            }
            UnitSystemError::Redundant { symbol, .. } => {
                write!(f, "`{symbol}` already follows from the units before it: leave it out")
            }
            UnitSystemError::Contradiction { symbol, instead, .. } => {
                write!(f, "`{symbol}` contradicts the units before it, which give `{instead}`")
            }
            UnitSystemError::Insufficient { missing } => {
                write!(f, "these units do not fix the unit of {}", missing.join(", "))
            }
        }
    }
}

impl std::error::Error for UnitSystemError {}
