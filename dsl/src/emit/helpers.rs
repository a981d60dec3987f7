//! Functions that the kernels of a model share: the geometry of elements.

use crate::kernel::{Job, Kernel};
use ansatz_elements::Cell;
use proc_macro2::TokenStream;
use quote::quote;

/// Functions that kernels share; those that none of these kernels needs are left out.
pub fn helpers(kernels: &[&Kernel]) -> TokenStream {
    let any = |needs: &dyn Fn(&Kernel) -> bool| kernels.iter().any(|kernel| needs(kernel));
    let symmetric = |kernel: &Kernel| matches!(&kernel.job, Job::Tangent(_, tangent) if tangent.symmetric);
    let lower = any(&symmetric).then(lower);
    let coordinate = any(&|kernel| kernel.coordinates.contains(&true)).then(coordinate);
    let triangle = any(&|kernel| kernel.cell == Cell::Triangle).then(triangle);
    let segment = any(&|kernel| kernel.cell == Cell::Segment).then(segment);
    let gradients = |kernel: &Kernel| kernel.uses.iter().any(|one| kernel.needs_gradients(one.field));
    let of = |cell: Cell| move |kernel: &Kernel| kernel.cell == cell && gradients(kernel);
    let pull_back = any(&of(Cell::Triangle)).then(pull_back);
    let along = any(&of(Cell::Segment)).then(along);
    let bends = |kernel: &Kernel| kernel.curvature.contains(&true);
    let curvature = any(&bends).then(curvature);
    let tangent = any(&|kernel| bends(kernel) || kernel.tangent.contains(&true)).then(tangent);
    quote!(#lower #coordinate #triangle #segment #pull_back #along #tangent #curvature)
}

fn lower() -> TokenStream {
    quote! {
        /// Position of entry (i, j), j <= i, in a lower triangle stored row by row.
        #[inline(always)]
        const fn lower(i: usize, j: usize) -> usize {
            i * (i + 1) / 2 + j
        }
    }
}

fn coordinate() -> TokenStream {
    quote! {
        /// A coordinate of the point.
        #[inline(always)]
        fn coordinate<S: Simd, const N: usize>(s: S, x: &[[Lane<S>; 2]; N], values: &[f64; N], axis: usize) -> Lane<S> {
            let mut sum = Lane::splat(s, 0.0);
            for a in 0..N {
                sum = x[a][axis].mul_add(Lane::splat(s, values[a]), sum);
            }
            sum
        }
    }
}

fn triangle() -> TokenStream {
    quote! {
        /// Inverse transposed Jacobian of a triangle at a point, by rows, and its determinant.
        #[inline(always)]
        fn triangle<S: Simd, const N: usize>(s: S, x: &[[Lane<S>; 2]; N], gradients: &[[f64; 2]; N]) -> ([[Lane<S>; 2]; 2], Lane<S>) {
            let mut j = [[Lane::splat(s, 0.0); 2]; 2];
            for a in 0..N {
                for i in 0..2 {
                    for k in 0..2 {
                        j[i][k] = x[a][i].mul_add(Lane::splat(s, gradients[a][k]), j[i][k]);
                    }
                }
            }
            let determinant = j[0][0] * j[1][1] - j[0][1] * j[1][0];
            let reciprocal = Lane::splat(s, 1.0) / determinant;
            let map = [[j[1][1] * reciprocal, -j[1][0] * reciprocal], [-j[0][1] * reciprocal, j[0][0] * reciprocal]];
            (map, determinant)
        }
    }
}

fn segment() -> TokenStream {
    quote! {
        /// Length of an edge per unit of its parameter at a point.
        #[inline(always)]
        fn segment<S: Simd, const N: usize>(s: S, x: &[[Lane<S>; 2]; N], gradients: &[[f64; 1]; N]) -> Lane<S> {
            let mut t = [Lane::splat(s, 0.0); 2];
            for a in 0..N {
                for i in 0..2 {
                    t[i] = x[a][i].mul_add(Lane::splat(s, gradients[a][0]), t[i]);
                }
            }
            (t[0] * t[0] + t[1] * t[1]).sqrt()
        }
    }
}

fn pull_back() -> TokenStream {
    quote! {
        /// Gradients of basis functions in the coordinates of the model.
        #[inline(always)]
        fn pull_back<S: Simd, const N: usize>(s: S, map: &[[Lane<S>; 2]; 2], reference: &[[f64; 2]; N]) -> [[Lane<S>; 2]; N] {
            let mut gradients = [[Lane::splat(s, 0.0); 2]; N];
            for a in 0..N {
                for i in 0..2 {
                    let second = map[i][1] * Lane::splat(s, reference[a][1]);
                    gradients[a][i] = map[i][0].mul_add(Lane::splat(s, reference[a][0]), second);
                }
            }
            gradients
        }
    }
}

fn along() -> TokenStream {
    quote! {
        /// Derivatives of basis functions by the arc length of an edge.
        #[inline(always)]
        fn edge_slopes<S: Simd, const N: usize>(s: S, measure: Lane<S>, reference: &[[f64; 1]; N]) -> [Lane<S>; N] {
            let reciprocal = Lane::splat(s, 1.0) / measure;
            let mut slopes = [reciprocal; N];
            for a in 0..N {
                slopes[a] = reciprocal * Lane::splat(s, reference[a][0]);
            }
            slopes
        }
    }
}

fn tangent() -> TokenStream {
    quote! {
        /// Unit tangent of an edge at a point.
        #[inline(always)]
        fn edge_tangent<S: Simd, const N: usize>(s: S, x: &[[Lane<S>; 2]; N], gradients: &[[f64; 1]; N], measure: Lane<S>) -> [Lane<S>; 2] {
            let mut t = [Lane::splat(s, 0.0); 2];
            for a in 0..N {
                for i in 0..2 {
                    t[i] = x[a][i].mul_add(Lane::splat(s, gradients[a][0]), t[i]);
                }
            }
            [t[0] / measure, t[1] / measure]
        }
    }
}

fn curvature() -> TokenStream {
    quote! {
        /// Curvature vector of a quadratic edge: the derivative of its tangent by the arc length.
        #[inline(always)]
        fn edge_curvature<S: Simd>(s: S, x: &[[Lane<S>; 2]; 3], tangent: [Lane<S>; 2], measure: Lane<S>) -> [Lane<S>; 2] {
            let scale = Lane::splat(s, 4.0) / (measure * measure);
            let second = [0, 1].map(|i| scale * (x[0][i] + x[1][i] - x[2][i] - x[2][i]));
            let part = tangent[0] * second[0] + tangent[1] * second[1];
            [second[0] - part * tangent[0], second[1] - part * tangent[1]]
        }
    }
}
