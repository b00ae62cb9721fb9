//! What the values of a motion are called in emitted code: `w3x` is the x component of the angular
//! velocity of link 3, `u3xy` an entry of U, `s1v4z` the linear z component of joint 1's screw in
//! frame 4, `r1w4x` a component of its rate.

use crate::expr::Graph;

use super::motion::{Motion, Mover};
use super::vector::{AXES, Vec3};

/// Names the motion of a link (links counted from 0 here, from 1 in names).
pub fn motion(graph: &mut Graph, link: usize, m: &Motion) {
    let k = link + 1;
    vector(graph, &format!("w{k}"), m.w);
    vector(graph, &format!("wd{k}"), m.wd);
    vector(graph, &format!("a{k}"), m.a);
    // Products before U: in a planar robot an entry of U is one of them.
    for (i, first) in AXES.iter().enumerate() {
        for (j, second) in AXES.iter().enumerate().skip(i) {
            let product = graph.mul(m.w[i], m.w[j]);
            graph.name(product, &format!("w{k}{first}{second}"));
        }
    }
    for (i, row) in m.u.iter().enumerate() {
        vector(graph, &format!("u{k}{}", AXES[i]), *row);
    }
    vector(graph, &format!("v{k}"), m.v);
    vector(graph, &format!("g{k}"), m.g);
    graph.name(m.potential, &format!("potential{k}"));
}

/// Names the screws of the joints that move a link.
pub fn movers(graph: &mut Graph, link: usize, movers: &[Mover]) {
    let k = link + 1;
    for mover in movers {
        let j = mover.joint + 1;
        vector(graph, &format!("s{j}w{k}"), mover.screw.angular);
        vector(graph, &format!("s{j}v{k}"), mover.screw.linear);
        vector(graph, &format!("r{j}w{k}"), mover.rate.angular);
        vector(graph, &format!("r{j}v{k}"), mover.rate.linear);
    }
}

fn vector(graph: &mut Graph, name: &str, vector: Vec3) {
    for (axis, component) in AXES.iter().zip(vector) {
        graph.name(component, &format!("{name}{axis}"));
    }
}
