//! Contact pairs of a program on a mesh: gaps at the current displacement, energies of the gap and loads on the surfaces.

mod side;

use super::unknowns::{FieldNumbers, NONE, Unknowns};
use crate::contact::{Area, Partner, Point};
use crate::error::Error;
use crate::generated::{Domain, ObservableKind, Pair, PairIntegral, PairLoad, PairValue, Program, Sides};
use crate::mesh::Mesh;
use crate::solve::sparse::{MatrixKind, SparsePattern};
use side::{Side, chains};

/// How far contact may move, in lengths of the longest slave edge, before the matrix pattern is made again.
const MARGIN: f64 = 4.0;
/// Samples for the gap beyond which all laws vanish.
const SAMPLES: usize = 64;

/// Whether a tangent has the part W'(g) Hess g, by which surfaces that turn and slide while they press can make it indefinite.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Curvature {
    /// The exact tangent.
    Kept,
    /// Only W''(g) grad g (grad g)^T: safer far from the solution, not quadratic near it.
    Dropped,
}

/// States and functionals (numbered one after another), and d residual / d each of them.
pub type GlobalColumns = (&'static [usize], Vec<Vec<f64>>);

/// A contact pair on a mesh.
pub struct PairOn {
    /// First and second, where anything needs them.
    sides: [Option<Side>; 2],
    integrals: Vec<&'static PairIntegral>,
    loads: Vec<&'static PairLoad>,
    weight: fn(Point) -> f64,
    displacement: usize,
    search: f64,
    /// Gap beyond which every law is zero.
    reach: f64,
    margin: f64,
    positions: Vec<Point>,
    /// The gaps are those of `positions`.
    updated: bool,
}

/// Pairs of a program; `g` holds parameters and constants.
pub fn prepare(program: &'static Program, mesh: &Mesh, g: &[f64]) -> Result<Vec<PairOn>, Error> {
    let on = |(k, pair)| PairOn::new(program, k, pair, mesh, g);
    program.pairs.iter().enumerate().map(on).collect()
}

impl PairOn {
    fn new(
        program: &'static Program,
        number: usize,
        pair: &'static Pair,
        mesh: &Mesh,
        g: &[f64],
    ) -> Result<Self, Error> {
        let integrals: Vec<&PairIntegral> =
            program.pair_integrals.iter().filter(|i| i.pair == number).collect();
        let loads: Vec<&PairLoad> = program.pair_loads.iter().filter(|load| load.pair == number).collect();
        let search = (pair.search)(g);
        let regions: Vec<&str> =
            program.fields[pair.displacement].domains.iter().flat_map(cells).copied().collect();
        let surfaces = [chains(mesh, pair.first, &regions)?, chains(mesh, pair.second, &regions)?];
        let [first, second] = needed(program, number);
        // Forces at a distance must not jump where surfaces turn away from each other.
        let partner = if loads.is_empty() { Partner::Facing } else { Partner::Nearest };
        let side = |slave: usize| {
            Side::new(program, mesh, &surfaces[slave], &surfaces[1 - slave], (partner, search))
        };
        let sides = [first.then(|| side(0)).transpose()?, second.then(|| side(1)).transpose()?];
        let edges = sides.iter().flatten().flat_map(|side| &side.edges);
        let longest = edges.map(|e| distance(mesh.nodes[e[0]], mesh.nodes[e[1]])).fold(0.0, f64::max);
        Ok(Self {
            // Forces seldom end before the search does, and may grow with what is not known yet.
            reach: if loads.is_empty() { reach(&integrals, search, g) } else { search },
            sides,
            integrals,
            loads,
            weight: program.weight,
            displacement: pair.displacement,
            search,
            margin: MARGIN * longest,
            positions: mesh.nodes.clone(),
            updated: false,
        })
    }

    /// Whether any law acts on it; else it is only looked at.
    pub fn acts(&self) -> bool {
        !self.integrals.is_empty() || !self.loads.is_empty()
    }

    /// Whether loads act on it, whose tangent has no symmetry.
    pub fn is_loaded(&self) -> bool {
        !self.loads.is_empty()
    }

    /// Whether a load on it reads states or functionals.
    pub fn reads_globals(&self) -> bool {
        self.loads.iter().any(|load| load.global_tangent.is_some())
    }

    /// Finds the gaps at the displacement in y; does nothing where they are known already.
    pub fn update(&mut self, mesh: &Mesh, unknowns: &Unknowns, y: &[f64]) {
        let field = &unknowns.fields[self.displacement];
        let mut moved = !self.updated;
        for (k, &node) in field.nodes.iter().enumerate() {
            let u = &y[field.first + 2 * k..][..2];
            let x = mesh.nodes[node as usize];
            let position = [x[0] + u[0], x[1] + u[1]];
            moved |= std::mem::replace(&mut self.positions[node as usize], position) != position;
        }
        if !moved {
            return;
        }
        self.updated = true;
        self.sides.iter_mut().flatten().for_each(|side| side.pair.update(&self.positions));
    }

    /// A value at every point of the surfaces meant that are there; the search distance is the gap where nothing faces a point.
    pub fn values(&self, sides: Sides, value: PairValue, g: &[f64]) -> impl Iterator<Item = f64> {
        self.meant(sides).flat_map(move |side| {
            let points = side.pair.gaps().iter().zip(side.pair.surfaces()).zip(&side.x);
            points.map(move |((gap, surface), x)| {
                value(gap.as_ref().map_or(self.search, |gap| gap.value), surface.normal(), *x, g)
            })
        })
    }

    /// Integral of a value over the points that the other surface faces.
    pub fn integral(&self, sides: Sides, current: bool, value: PairValue, g: &[f64]) -> f64 {
        let area = self.area(current);
        let of = |side: &Side| side.pair.integral(area, &|k, gap, normal| value(gap, normal, side.x[k], g));
        self.meant(sides).map(of).sum()
    }

    fn area(&self, current: bool) -> Area {
        if current { Area::Current(self.weight) } else { Area::Reference }
    }

    fn meant(&self, sides: Sides) -> impl Iterator<Item = &Side> {
        let meant = self.sides.iter().enumerate().filter(move |(k, _)| sides.has(*k));
        meant.filter_map(|(_, side)| side.as_ref())
    }

    /// Groups of unknowns that contact may couple until the surfaces have moved by the margin, around the last update.
    pub fn couplings(&mut self, unknowns: &Unknowns) -> Vec<Vec<u32>> {
        let field = &unknowns.fields[self.displacement];
        let (reach, margin) = (self.reach, self.margin);
        let radius = reach.min(margin) + margin;
        let mut groups = Vec::new();
        for side in self.sides.iter_mut().flatten() {
            side.potential = side.pair.potential_nodes(&self.positions, radius, (reach, margin));
            for (edge, masters) in side.edges.iter().zip(&side.potential).filter(|(_, m)| !m.is_empty()) {
                let nodes = edge.iter().chain(masters);
                groups.push(nodes.flat_map(|&n| unknowns_of(field, n)).map(|u| u as u32).collect());
            }
        }
        groups
    }

    /// Whether the couplings of the last [`PairOn::couplings`] hold those of the present gaps.
    pub fn covered(&self) -> bool {
        let limit = self.reach.max(f64::MIN_POSITIVE);
        self.sides.iter().flatten().all(|side| side.pair.covered(&side.potential, limit))
    }

    /// Adds the residual of the energies and loads of wanted blocks.
    pub fn add_residual(
        &self,
        unknowns: &Unknowns,
        g: &[f64],
        wanted: &dyn Fn(usize) -> bool,
        residual: &mut [f64],
    ) {
        let field = &unknowns.fields[self.displacement];
        for (integral, side) in self.integrals_on_sides().filter(|(i, _)| wanted(i.block)) {
            let law = |point: usize, gap: f64| (integral.law)(gap, side.x[point], g);
            side.pair.gradient(&law, |(node, component), value| {
                if let Some(unknown) = field.unknown(node, component) {
                    residual[unknown] += value;
                }
            });
        }
        for load in self.loads.iter().filter(|load| wanted(load.block)) {
            let flux = |x: Point, gap: f64, normal: Point| traction(load, x, gap, normal, g)[0];
            self.add_work(load, field, &flux, residual);
        }
    }

    /// Adds the work of a flux on the surfaces of a load.
    fn add_work(
        &self,
        load: &PairLoad,
        field: &FieldNumbers,
        flux: &dyn Fn(Point, f64, Point) -> Point,
        sum: &mut [f64],
    ) {
        for side in self.meant(load.sides) {
            let flux = |k: usize, gap: f64, normal: Point| flux(side.x[k], gap, normal);
            side.pair.add_work(self.area(load.current), &flux, |(node, component), value| {
                if let Some(unknown) = field.unknown(node, component) {
                    sum[unknown] += value;
                }
            });
        }
    }

    /// For each load that reads states or functionals, which ones, and d residual / d each of them.
    pub fn global_tangents(&self, unknowns: &Unknowns, g: &[f64], alpha: f64) -> Vec<GlobalColumns> {
        let field = &unknowns.fields[self.displacement];
        let with_globals = self.loads.iter().filter_map(|load| Some((load, load.global_tangent.as_ref()?)));
        let columns = with_globals.map(|(load, tangent)| {
            let column = |slot: usize| {
                let mut sum = vec![0.0; unknowns.length];
                let flux = |x: Point, gap: f64, normal: Point| {
                    let mut out = vec![[0.0; 2]; tangent.slots.len()];
                    (tangent.law)(gap, normal, x, g, alpha, &mut out);
                    out[slot]
                };
                self.add_work(load, field, &flux, &mut sum);
                sum
            };
            (tangent.slots, (0..tangent.slots.len()).map(column).collect())
        });
        columns.collect()
    }

    /// Adds residual and tangent of all energies and loads; `values` has a spare last entry.
    pub fn add_tangent(
        &self,
        unknowns: &Unknowns,
        g: &[f64],
        matrix: (&SparsePattern, &[u32]),
        curvature: Curvature,
        residual: &mut [f64],
        values: &mut [f64],
    ) {
        self.add_residual(unknowns, g, &|_| true, residual);
        let (pattern, equations) = matrix;
        let field = &unknowns.fields[self.displacement];
        let equation = |(node, component)| {
            let unknown = field.unknown(node, component)?;
            Some(equations[unknown]).filter(|&e| e != NONE)
        };
        let mut add = |row, column, value: f64| {
            let (Some(row), Some(column)) = (equation(row), equation(column)) else { return };
            if pattern.kind() == MatrixKind::Symmetric && row < column {
                return;
            }
            if let Some(position) = pattern.position(row, column) {
                values[position] += value;
            }
        };
        for (integral, side) in self.integrals_on_sides() {
            let law = |point: usize, gap: f64| {
                let [energy, force, stiffness] = (integral.law)(gap, side.x[point], g);
                [energy, if curvature == Curvature::Kept { force } else { 0.0 }, stiffness]
            };
            side.pair.hessian(&law, &mut add);
        }
        for load in &self.loads {
            for side in self.meant(load.sides) {
                let law = |k: usize, gap: f64, normal: Point| traction(load, side.x[k], gap, normal, g);
                side.pair.add_work_tangent(self.area(load.current), &law, &mut add);
            }
        }
    }

    fn integrals_on_sides(&self) -> impl Iterator<Item = (&'static PairIntegral, &Side)> {
        let on_sides =
            |&integral: &&'static PairIntegral| self.meant(integral.sides).map(move |side| (integral, side));
        self.integrals.iter().flat_map(on_sides)
    }
}

/// The surfaces of a pair that laws or outputs need, at least one.
fn needed(program: &Program, number: usize) -> [bool; 2] {
    let laws = program.pair_integrals.iter().filter(|i| i.pair == number).map(|i| i.sides);
    let loads = program.pair_loads.iter().filter(|load| load.pair == number).map(|load| load.sides);
    let looked_at = program.observables.iter().filter_map(|observable| match observable.kind {
        ObservableKind::PairIntegral { pair, sides, .. } if pair == number => Some(sides),
        ObservableKind::PairMin(pair, sides, _) | ObservableKind::PairMax(pair, sides, _)
            if pair == number =>
        {
            Some(sides).filter(|sides| *sides != Sides::Both)
        }
        _ => None,
    });
    let all: Vec<Sides> = laws.chain(loads).chain(looked_at).collect();
    let [first, second] = [0, 1].map(|side| all.iter().any(|sides| sides.has(side)));
    [first || !second, second]
}

/// Regions of a domain.
fn cells(domain: &Domain) -> &'static [&'static str] {
    if let Domain::Cells(regions) = domain { regions } else { &[] }
}

/// Flux and derivatives of a load at a point.
fn traction(load: &PairLoad, x: Point, gap: f64, normal: Point, g: &[f64]) -> [Point; 4] {
    let mut out = [[0.0; 2]; 4];
    (load.law)(gap, normal, x, g, &mut out);
    out
}

/// Unknowns of both components at a node.
fn unknowns_of(field: &FieldNumbers, node: usize) -> impl Iterator<Item = usize> + '_ {
    (0..2).filter_map(move |component| field.unknown(node, component))
}

/// Gap beyond which all laws are zero, up to the search distance.
fn reach(integrals: &[&PairIntegral], search: f64, g: &[f64]) -> f64 {
    let acts = |gap: f64| integrals.iter().any(|i| (i.law)(gap, [0.0; 2], g) != [0.0; 3]);
    let gap = |k: usize| search * k as f64 / SAMPLES as f64;
    (1..=SAMPLES).rev().find(|&k| acts(gap(k))).map_or(0.0, |k| gap((k + 1).min(SAMPLES)))
}

fn distance(a: Point, b: Point) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}
