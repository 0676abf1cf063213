//! A robot of boxes with its kinematics and collisions written once more, in plain matrices and the platform's sine: what the crate
//! is held against.

use glam::{DMat3, DVec3};
use std::fmt::Write;

/// A box on a link, and the joint that carries the link.
#[derive(Clone)]
pub(crate) struct BoxLink {
    pub(crate) parent: Option<usize>,
    pub(crate) kind: &'static str,
    pub(crate) xyz: DVec3,
    pub(crate) rpy: DVec3,
    pub(crate) axis: DVec3,
    pub(crate) size: DVec3,
    /// Frame of the box on the link.
    pub(crate) at: DVec3,
    pub(crate) turn: DVec3,
    /// Joint that is followed, multiplier, offset.
    pub(crate) mimic: Option<(usize, f64, f64)>,
}

#[derive(Clone)]
pub(crate) struct BoxArm {
    pub(crate) links: Vec<BoxLink>,
}

/// A box in the world.
#[derive(Clone, Copy)]
pub(crate) struct PlacedBox {
    pub(crate) center: DVec3,
    pub(crate) axes: DMat3,
    pub(crate) half: DVec3,
}

fn text(v: DVec3) -> String {
    format!("{:?} {:?} {:?}", v.x, v.y, v.z)
}

fn rotation(axis: DVec3, angle: f64) -> DMat3 {
    let k = axis / axis.length();
    let (s, c) = angle.sin_cos();
    let cross =
        DMat3::from_cols(DVec3::new(0.0, k.z, -k.y), DVec3::new(-k.z, 0.0, k.x), DVec3::new(k.y, -k.x, 0.0));
    DMat3::IDENTITY + cross * s + cross * cross * (1.0 - c)
}

fn rpy(v: DVec3) -> DMat3 {
    rotation(DVec3::Z, v.z) * rotation(DVec3::Y, v.y) * rotation(DVec3::X, v.x)
}

impl BoxArm {
    pub(crate) fn urdf(&self) -> String {
        let mut urdf = String::from("<robot name=\"boxes\">\n");
        for (k, link) in self.links.iter().enumerate() {
            let [size, at, turn] = [link.size, link.at, link.turn].map(text);
            let _ = writeln!(
                urdf,
                "<link name=\"l{k}\"><collision><origin xyz=\"{at}\" rpy=\"{turn}\"/>\
                 <geometry><box size=\"{size}\"/></geometry></collision></link>"
            );
            let Some(parent) = link.parent else { continue };
            let [xyz, rpy, axis] = [link.xyz, link.rpy, link.axis].map(text);
            let mimic = link.mimic.map_or(String::new(), |(joint, multiplier, offset)| {
                format!("<mimic joint=\"j{joint}\" multiplier=\"{multiplier:?}\" offset=\"{offset:?}\"/>")
            });
            let _ = writeln!(
                urdf,
                "<joint name=\"j{k}\" type=\"{}\"><parent link=\"l{parent}\"/><child link=\"l{k}\"/>\
                 <origin xyz=\"{xyz}\" rpy=\"{rpy}\"/><axis xyz=\"{axis}\"/>{mimic}\
                 <limit lower=\"-9\" upper=\"9\" velocity=\"99\"/></joint>",
                link.kind
            );
        }
        urdf + "</robot>"
    }

    /// All boxes, by the values of the joints (index 0 is the root's, which has none).
    pub(crate) fn place(&self, q: &[f64]) -> Vec<PlacedBox> {
        let mut frames: Vec<(DMat3, DVec3)> = Vec::new();
        for (k, link) in self.links.iter().enumerate() {
            let Some(parent) = link.parent else {
                frames.push((DMat3::IDENTITY, DVec3::ZERO));
                continue;
            };
            let (r, x) = frames[parent];
            let (mut turn, mut at) = (r * rpy(link.rpy), x + r * link.xyz);
            match link.kind {
                "revolute" | "continuous" => turn *= rotation(link.axis, q[k]),
                "prismatic" => at += turn * (link.axis / link.axis.length() * q[k]),
                _ => {}
            }
            frames.push((turn, at));
        }
        let boxes = self.links.iter().zip(&frames);
        boxes
            .map(|(link, (r, x))| PlacedBox {
                center: *x + *r * link.at,
                axes: *r * rpy(link.turn),
                half: link.size * 0.5,
            })
            .collect()
    }
}

impl PlacedBox {
    /// Separating axes of two boxes: positive is a distance along one of them, which is a lower bound of theirs.
    pub(crate) fn gap(&self, other: &Self) -> f64 {
        let (a, b) = (self.axes, other.axes);
        let mut axes = vec![a.x_axis, a.y_axis, a.z_axis, b.x_axis, b.y_axis, b.z_axis];
        for p in [a.x_axis, a.y_axis, a.z_axis] {
            for q in [b.x_axis, b.y_axis, b.z_axis] {
                let n = p.cross(q);
                if n.length() > 1e-9 {
                    axes.push(n.normalize());
                }
            }
        }
        let reach = |of: &Self, n: DVec3| (of.axes.transpose() * n).abs().dot(of.half);
        let apart = self.center - other.center;
        axes.into_iter()
            .map(|n| apart.dot(n).abs() - reach(self, n) - reach(other, n))
            .fold(f64::NEG_INFINITY, f64::max)
    }
}
