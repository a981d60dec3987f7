//! Geometry, mesh sizes and settings of the solution, as functions of the parameters.

use super::body::{Sources, body, list};
use super::expression::number;
use super::layout::Slots;
use super::pairs;
use crate::form::Forms;
use crate::form::settings::Path;
use crate::lower::piece_name;
use crate::model::{Frame, Integrator, Model, Piece, Turn};
use crate::scalar::Id;
use proc_macro2::{Literal, TokenStream};
use quote::quote;

/// `fn geometry(g)`.
pub fn geometry(forms: &mut Forms<'_>, slots: &Slots) -> TokenStream {
    let (model, paths) = (forms.lowering.model, forms.settings.paths.clone());
    let roots: Vec<Id> = paths.iter().flat_map(roots).collect();
    let body = body(&mut forms.lowering, slots, Sources::default(), &roots);
    let mut results = body.results.chunks(2).map(|point| {
        let (x, y) = (&point[0], &point[1]);
        quote!([#x, #y])
    });
    let mut next = || results.next().unwrap_or_default();
    let builders = model.geometry.paths.iter().zip(&paths).map(|(definition, path)| {
        let (name, start) = (&definition.name, next());
        let segments = definition.segments.iter().zip(&path.segments).map(|(segment, lowered)| {
            let label = match &segment.label {
                Some(label) => quote!(Some(#label)),
                None => quote!(None),
            };
            let to = next();
            match &lowered.arc {
                None => quote!(.line(#label, #to)),
                Some((_, turn)) => {
                    let (centre, turn) =
                        (next(), if *turn == Turn::Clockwise { quote!(Turn::Cw) } else { quote!(Turn::Ccw) });
                    quote!(.arc(#label, #centre, #turn, #to))
                }
            }
        });
        let segments: Vec<TokenStream> = segments.collect();
        quote!(PathBuilder::from(#name, #start) #(#segments)* .build())
    });
    let builders: Vec<TokenStream> = builders.collect();
    let regions = model.geometry.regions.iter().map(|region| {
        let (name, parts) = (&region.name, region.boundary.iter().map(|&piece| loop_part(model, piece)));
        quote!(Region::new(#name, [#(#parts),*]))
    });
    let (statements, axisymmetric) = (&body.statements, model.coordinates.frame == Frame::Axisymmetric);
    let argument = if body.reads_globals { quote!(g) } else { quote!(_) };
    quote! {
        /// The paths and regions for given parameters.
        fn geometry(#argument: &[f64]) -> Result<Geometry, Vec<GeometryError>> {
            #(#statements)*
            let mut paths = Vec::new();
            let mut errors = Vec::new();
            for path in [#(#builders),*] {
                match path {
                    Ok(path) => paths.push(path),
                    Err(mut found) => errors.append(&mut found),
                }
            }
            let regions = Vec::from([#(#regions),*]);
            if errors.is_empty() { Ok(Geometry { paths, regions, axisymmetric: #axisymmetric }) } else { Err(errors) }
        }
    }
}

/// Points of a path in the order in which builders read them: start, then end and centre of each segment.
fn roots(path: &Path) -> Vec<Id> {
    let mut roots = path.start.to_vec();
    for segment in &path.segments {
        roots.extend(segment.to);
        roots.extend(segment.arc.iter().flat_map(|(centre, _)| centre));
    }
    roots
}

fn loop_part(model: &Model, piece: Piece) -> TokenStream {
    match piece {
        Piece::Axis => quote!(LoopPart::Axis),
        Piece::Segment(path, _) => {
            let (path, whole) = (&model.geometry.paths[path.0].name, piece_name(model, piece));
            let label = whole.rsplit('.').next().unwrap_or_default();
            quote!(LoopPart::segment(#path, #label))
        }
        _ => {
            let name = piece_name(model, piece);
            quote!(LoopPart::path(#name))
        }
    }
}

/// `|g| MeshSizing { .. }`.
pub fn sizing(forms: &mut Forms<'_>, slots: &Slots) -> TokenStream {
    let (model, mesh) = (forms.lowering.model, forms.settings.mesh.clone());
    let mut roots: Vec<Id> = mesh.sizes.iter().map(|(size, _)| *size).collect();
    roots.extend([mesh.growth, mesh.quality]);
    list(&mut forms.lowering, slots, &roots, &|values| {
        let rules = mesh.sizes.iter().zip(values).map(|((_, domain), size)| {
            let places: Vec<TokenStream> = match domain {
                None => vec![quote!(Place::Everywhere)],
                Some(domain) => domain.pieces.iter().map(|&piece| place(model, piece)).collect(),
            };
            quote!(SizeRule { size: #size, on: Vec::from([#(#places),*]) })
        });
        let (growth, quality) = (&values[values.len() - 2], &values[values.len() - 1]);
        quote!(MeshSizing { rules: Vec::from([#(#rules),*]), growth: #growth, quality: #quality })
    })
}

/// The entries of `Program::gap_sizes`.
pub fn gap_sizes(forms: &mut Forms<'_>, slots: &Slots) -> TokenStream {
    let sizes = forms.settings.mesh.gap_sizes.clone();
    let entries = sizes.into_iter().map(|(size, pair, sides)| {
        let (pair, sides) = (Literal::usize_unsuffixed(pair.0), pairs::sides(sides));
        let size = pairs::value(&mut forms.lowering, slots, size);
        quote!(GapSize { pair: #pair, sides: #sides, size: #size })
    });
    let entries: Vec<TokenStream> = entries.collect();
    quote!(&[#(#entries),*])
}

fn place(model: &Model, piece: Piece) -> TokenStream {
    let name = piece_name(model, piece);
    match piece {
        Piece::Region(_) => quote!(Place::Region(#name.into())),
        Piece::Start(path) => {
            let path = &model.geometry.paths[path.0].name;
            quote!(Place::Start(#path.into()))
        }
        Piece::End(path) => {
            let path = &model.geometry.paths[path.0].name;
            quote!(Place::End(#path.into()))
        }
        Piece::Segment(path, _) => {
            let (path, label) =
                (&model.geometry.paths[path.0].name, name.rsplit('.').next().unwrap_or_default());
            quote!(Place::Segment(#path.into(), #label.into()))
        }
        _ => quote!(Place::Path(#name.into())),
    }
}

/// `|g| Solve { .. }`.
pub fn solve(forms: &mut Forms<'_>, slots: &Slots) -> TokenStream {
    let solve = forms.settings.solve.clone();
    let integrator = match solve.integrator {
        Integrator::Sdirk2 => quote!(Integrator::Sdirk2),
        Integrator::BackwardEuler => quote!(Integrator::BackwardEuler),
    };
    let iterations = forms.lowering.pool.as_constant(solve.newton_iterations);
    // What follows from parameters may turn out to be no step.
    let steps = [solve.max_step, solve.min_step].map(|step| forms.lowering.pool.as_constant(step).is_none());
    let mut roots = vec![
        solve.max_step,
        solve.min_step,
        solve.step_tolerance,
        solve.newton_tolerance,
        solve.newton_iterations,
    ];
    roots.extend(solve.time.iter().flatten());
    list(&mut forms.lowering, slots, &roots, &|values| {
        let [max_step, min_step, step_tolerance, newton_tolerance, newton_iterations, time @ ..] = values
        else {
            return TokenStream::new();
        };
        let time = if time.is_empty() { quote!(None) } else { quote!(Some((#(#time),*))) };
        let iterations = match iterations {
            Some(count) => {
                let count = Literal::usize_unsuffixed(count as usize);
                quote!(#count)
            }
            None => quote!(whole(#newton_iterations)),
        };
        let step = |follows: bool, value| if follows { quote!(named_step(#value)) } else { quote!(#value) };
        let (max_step, min_step) = (step(steps[0], max_step), step(steps[1], min_step));
        quote!(Solve {
            time: #time,
            integrator: #integrator,
            max_step: #max_step,
            min_step: #min_step,
            step_tolerance: #step_tolerance,
            newton_tolerance: #newton_tolerance,
            newton_iterations: #iterations,
        })
    })
}

/// Weight of the measure at a point.
pub fn weight(model: &Model) -> TokenStream {
    match model.coordinates.frame {
        Frame::Axisymmetric => {
            let tau = number(std::f64::consts::TAU);
            quote!(|x| #tau * x[0])
        }
        Frame::PlaneStrain => quote!(|_| 1.0),
    }
}
