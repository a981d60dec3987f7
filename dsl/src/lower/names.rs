//! Readable names of symbols and domains, for listings and emitted code.

use super::{Derivative, FieldInput, Lowering, Region, SymbolKind, Value};
use crate::model::{Builtin, Expr, ExprKind, Frame, Model, Piece, Shape};
use crate::scalar::Id;

/// Name of a field's scalar: `u_r`, `du_r_dz`, `phi`, `dphi_dx`.
pub fn input_name(model: &Model, input: FieldInput) -> String {
    let field = &model.fields[input.field.0];
    let value = match field.shape {
        Shape::Scalar => field.name.clone(),
        _ => format!("{}_{}", field.name, model.coordinates.names[input.component]),
    };
    match input.derivative {
        None => value,
        Some(Derivative::Coordinate(direction)) => {
            format!("d{value}_d{}", model.coordinates.names[direction])
        }
        Some(Derivative::Along) => format!("d{value}_ds"),
    }
}

/// Name of a symbol; different symbols of one kernel have different names unless the model's own names clash.
pub fn symbol_name(lowering: &Lowering<'_>, kind: SymbolKind) -> String {
    use SymbolKind as K;
    let model = lowering.model;
    match kind {
        K::Parameter(param) => model.params[param.0].name.clone(),
        K::Measure(measure) => format!(
            "measure_{}",
            region_names(model, &lowering.measures[measure]).join("_").replace('.', "_")
        ),
        K::Table(table) => lowering.tables[table].name.clone(),
        K::Time => String::from("t"),
        K::State(state) => model.states[state.0].name.clone(),
        K::StateRate(state) => format!("dt_{}", model.states[state.0].name),
        K::Quantity(quantity) => lowering.quantities[quantity].name.clone(),
        K::QuantityRate(quantity) => format!("dt_{}", lowering.quantities[quantity].name),
        K::Coordinate(axis) => model.coordinates.names[axis].clone(),
        K::Tangent(axis) => format!("tangent_{}", model.coordinates.names[axis]),
        K::Curvature(axis) => format!("curvature_{}", model.coordinates.names[axis]),
        K::Field(input) => input_name(model, input),
        K::FieldRate(input) => format!("dt_{}", input_name(model, input)),
        K::Frozen(input) => format!("frozen_{}", input_name(model, input)),
        K::Test(input) => format!("test_{}", input_name(model, input)),
        K::Normal(_, axis) => format!("n_{}", model.coordinates.names[axis]),
        K::Gap(_) => String::from("gap"),
        K::PairNormal(_, axis) => format!("n_{}", model.coordinates.names[axis]),
        K::Alpha => String::from("alpha"),
        K::Weight => String::from("weight"),
        K::Switch(number) => format!("switch_{number}"),
        K::Run(number) => format!("run_{number}"),
        K::Bound(number) => format!("x_{number}"),
        K::BoundRate(number) => format!("dt_x_{number}"),
    }
}

/// The pieces of a domain as the mesh knows them: `core`, `nucleus`, `nucleus.pull`, `axis`.
pub fn region_names(model: &Model, region: &Region) -> Vec<String> {
    match region {
        Region::Cells(regions) => regions.iter().map(|r| model.geometry.regions[r.0].name.clone()).collect(),
        Region::Edges(pieces) | Region::Ends(pieces) => {
            pieces.iter().map(|&piece| piece_name(model, piece)).collect()
        }
    }
}

/// Names of a domain on which fields are seen: paths around a moving region have its name before them where they are seen with its fields.
pub fn names_for(
    model: &Model,
    region: &Region,
    mut fields: impl Iterator<Item = crate::model::FieldId>,
) -> Vec<String> {
    let names = region_names(model, region);
    match (region, fields.find_map(|field| model.moving_home(field))) {
        (Region::Edges(_), Some(home)) => {
            let home = &model.geometry.regions[home.0].name;
            names.into_iter().map(|name| format!("{home}/{name}")).collect()
        }
        _ => names,
    }
}

/// Name of one piece of a domain.
pub fn piece_name(model: &Model, piece: Piece) -> String {
    match piece {
        Piece::Region(region) => model.geometry.regions[region.0].name.clone(),
        Piece::Path(path) => model.geometry.paths[path.0].name.clone(),
        Piece::Segment(path, segment) => {
            let path = &model.geometry.paths[path.0];
            match path.segments.get(segment).and_then(|segment| segment.label.as_ref()) {
                Some(label) => format!("{}.{label}", path.name),
                None => path.name.clone(),
            }
        }
        Piece::Axis => String::from("axis"),
        Piece::Start(path) => format!("{}.start", model.geometry.paths[path.0].name),
        Piece::End(path) => format!("{}.end", model.geometry.paths[path.0].name),
        Piece::Pair(pair, _) => model.pairs[pair.0].name.clone(),
    }
}

impl Lowering<'_> {
    /// Remembers what the model calls a value, component by component; the first name of a scalar stays.
    pub(super) fn hint(&mut self, value: &Value, name: &str) {
        let axes = match self.model.coordinates.frame {
            Frame::Axisymmetric => {
                [&self.model.coordinates.names[0], "theta", &self.model.coordinates.names[1]]
            }
            Frame::PlaneStrain => [&self.model.coordinates.names[0], &self.model.coordinates.names[1], "z"],
        };
        let mut names: Vec<(Id, String)> = Vec::new();
        match value {
            Value::Scalar(x) => names.push((*x, name.to_owned())),
            Value::Vector(v) => {
                names.extend(v.iter().zip(axes).map(|(x, axis)| (*x, format!("{name}_{axis}"))))
            }
            Value::Tensor(a) => {
                names.extend(
                    a.iter().enumerate().map(|(k, x)| (*x, format!("{name}_{}{}", axes[k / 3], axes[k % 3]))),
                );
            }
            _ => {}
        }
        for (id, name) in names {
            if self.pool.node(id).cost() > 0 {
                self.hints.entry(id).or_insert(name);
            }
        }
    }

    /// Name of a determinant, trace, norm or inverse after its argument.
    pub(super) fn hint_builtin(&mut self, builtin: Builtin, argument: Option<&Expr>, value: &Value) {
        let function = match builtin {
            Builtin::Det => "det",
            Builtin::Trace => "tr",
            Builtin::Norm => "norm",
            Builtin::Inverse => "inverse",
            _ => return,
        };
        let model = self.model;
        let of = match argument.map(|argument| &argument.kind) {
            Some(ExprKind::Local(local)) => &model.locals[local.0],
            Some(ExprKind::Let(id)) => &model.lets[id.0].name,
            Some(ExprKind::Apply(function, _)) => &model.functions[function.0].name,
            _ => return,
        };
        self.hint(value, &format!("{function}_{of}"));
    }
}
