//! The geometry of the dry-contact model: nucleus core and shell, endothelium with a round rim, matrix with a cavity.

use ansatz_geometry::{Geometry, LoopPart, Path, PathBuilder, Region, Turn, polar};
use std::f64::consts::{FRAC_PI_2, PI};

/// The parameters of the geometry \[um\].
#[derive(Debug, Clone, Copy)]
pub struct Dry {
    pub r_n: f64,
    pub delta: f64,
    pub h: f64,
    pub r_g: f64,
    pub big_r: f64,
    pub z_n: f64,
    pub big_l: f64,
    pub big_h: f64,
    pub a_b: f64,
    pub a_n: f64,
}

impl Default for Dry {
    fn default() -> Self {
        Dry {
            r_n: 3.0,
            delta: 0.3,
            h: 6.0,
            r_g: 1.5,
            big_r: 7.5,
            z_n: -5.0,
            big_l: 20.0,
            big_h: 28.0,
            a_b: 4.0,
            a_n: 4.0,
        }
    }
}

impl Dry {
    /// Centre of the cavity on the axis.
    pub fn z_c(&self) -> f64 {
        self.z_n + 13.0
    }

    /// Radius where the cavity meets the top of the endothelium.
    pub fn r_j(&self) -> f64 {
        (self.big_r.powi(2) - (self.z_c() - self.h / 2.0).powi(2)).sqrt()
    }

    /// The geometry with its regions core, shell, ec and ecm.
    pub fn geometry(&self) -> Geometry {
        let (part, axis) = (LoopPart::path, LoopPart::Axis);
        let regions = vec![
            Region::new("core", [part("core_wall"), axis.clone()]),
            Region::new("shell", [part("nucleus"), part("core_wall"), axis]),
            Region::new("ec", [part("endo"), part("seam"), part("ec_side")]),
            Region::new("ecm", [part("cavity"), part("block"), part("seam")]),
        ];
        Geometry { paths: self.paths(), regions, axisymmetric: true }
    }

    fn paths(&self) -> Vec<Path> {
        let Dry { r_n, delta, h, r_g, big_r, z_n, big_l, big_h, a_b, a_n } = *self;
        let (r_c, z_c, r_j) = (r_n - delta, self.z_c(), self.r_j());
        let th_n = (1.0 - a_n / (2.0 * PI * r_n * r_n)).acos();
        let th_b = (1.0 - a_b / (2.0 * PI * big_r * big_r)).acos();
        let (on, oc, oe) = ([0.0, z_n], [0.0, z_c], [r_g + h / 2.0, 0.0]);
        let builders = [
            PathBuilder::from("core_wall", [0.0, z_n - r_c]).arc(None, on, Turn::Ccw, [0.0, z_n + r_c]),
            PathBuilder::from("nucleus", [0.0, z_n - r_n])
                .arc(Some("side"), on, Turn::Ccw, polar(on, r_n, FRAC_PI_2 - th_n))
                .arc(Some("pull"), on, Turn::Ccw, [0.0, z_n + r_n]),
            PathBuilder::from("endo", [big_l, -h / 2.0])
                .line(Some("bottom"), [r_g + h / 2.0, -h / 2.0])
                .arc(Some("rim"), oe, Turn::Cw, [r_g + h / 2.0, h / 2.0])
                .line(Some("top"), [r_j, h / 2.0]),
            PathBuilder::from("cavity", [r_j, h / 2.0])
                .arc(Some("wall"), oc, Turn::Ccw, polar(oc, big_r, FRAC_PI_2 - th_b))
                .arc(Some("roof"), oc, Turn::Ccw, [0.0, z_c + big_r]),
            PathBuilder::from("seam", [r_j, h / 2.0]).line(None, [big_l, h / 2.0]),
            PathBuilder::from("block", [0.0, z_c + big_r])
                .line(None, [0.0, big_h])
                .line(Some("lid"), [big_l, big_h])
                .line(Some("ecm_side"), [big_l, h / 2.0]),
            PathBuilder::from("ec_side", [big_l, h / 2.0]).line(None, [big_l, -h / 2.0]),
        ];
        builders.into_iter().map(|builder| builder.build().expect("ends lie on their circles")).collect()
    }
}
