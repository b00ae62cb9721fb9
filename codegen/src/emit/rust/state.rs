//! The state of a robot with the sines and cosines that all outputs share.

use proc_macro2::{Literal, TokenStream};
use quote::{format_ident, quote};

use super::parsed;
use crate::emit::angles;
use crate::expr::schedule;
use crate::robot::{Output, Robot};

/// `State<T>` and its constructor.
///
/// # Errors
/// A message if an angle is not Rust: a defect of the generator.
pub fn state(robot: &Robot) -> Result<TokenStream, String> {
    let mut fields = TokenStream::new();
    let (mut angles, mut pairs) = (vec![], vec![]);
    let mut names = TokenStream::new();
    for trig in trig(robot) {
        let text = trig.text();
        let sum = trig.code(
            |joint| format!("q[{joint}]"),
            |value| format!("q[0].splat({})", Literal::f64_unsuffixed(value)),
        );
        angles.push(parsed(&sum)?);
        let mut pair = Vec::new();
        for (name, function) in [(&trig.sine, "sin"), (&trig.cosine, "cos")] {
            let Some(name) = name.as_ref().map(|name| format_ident!("{name}")) else {
                pair.push(quote! { _ });
                continue;
            };
            let doc = format!(" {function}({text})");
            fields.extend(quote! { #[doc = #doc] pub #name: T, });
            names.extend(quote! { #name, });
            pair.push(quote! { #name });
        }
        pairs.push(quote! { (#(#pair),*) });
    }
    let fours = pairs.chunks(4).zip(angles.chunks(4));
    let bindings = fours.map(|(pairs, angles)| {
        quote! { let [#(#pairs),*] = T::sines_and_cosines([#(#angles),*]); }
    });
    let bindings: TokenStream = bindings.collect();
    Ok(definition(robot, &fields, &bindings, &names))
}

/// Sines and cosines that any output needs.
fn trig(robot: &Robot) -> Vec<angles::Trig> {
    let beside = robot
        .functions
        .iter()
        .flat_map(|f| f.entries.iter().flatten().copied());
    let values: Vec<_> = Output::ALL
        .into_iter()
        .flat_map(|output| robot.entries(output))
        .map(|entry| entry.value)
        .chain(beside)
        .collect();
    let mut needed = schedule::order(&robot.graph, &values);
    needed.sort_unstable();
    angles::trig(&robot.graph, &needed)
}

fn definition(
    robot: &Robot,
    fields: &TokenStream,
    bindings: &TokenStream,
    names: &TokenStream,
) -> TokenStream {
    let [slip_field, slip_value, slip_name, with_slip] = slip(robot);
    quote! {
        #[doc = " A state of the robot, with the sines and cosines that all outputs share."]
        #[derive(Clone, Copy, Debug)]
        pub struct State<T> {
            #[doc = " Joint positions, rad or m."]
            pub q: [T; JOINTS],
            #[doc = " Joint velocities, rad/s or m/s."]
            pub qd: [T; JOINTS],
            #[doc = " Joint accelerations, rad/s^2 or m/s^2."]
            pub qdd: [T; JOINTS],
            #slip_field
            #fields
        }

        impl<T: Lane> State<T> {
            #[doc = " Computes each sine and cosine once."]
            #[inline(always)]
            pub fn new(q: [T; JOINTS], qd: [T; JOINTS], qdd: [T; JOINTS]) -> Self {
                #slip_value
                #bindings
                State { q, qd, qdd, #slip_name #names }
            }
            #with_slip
            #[doc = " The same constant in every lane."]
            #[inline(always)]
            pub fn constant(&self, value: f64) -> T {
                self.q[0].splat(value)
            }
        }
    }
}

/// The presliding states as a field, as the constructor sets them, and how a caller does; empty
/// for a robot whose friction has no memory.
fn slip(robot: &Robot) -> [TokenStream; 4] {
    if robot.mechanism.presliding().next().is_none() {
        return Default::default();
    }
    [
        quote! {
            #[doc = " Presliding states z/zs; the signs of the velocities in sliding."]
            pub slip: [T; JOINTS],
        },
        quote! {
            let mut slip = qd;
            for slip in &mut slip {
                *slip = slip.sign();
            }
        },
        quote! { slip, },
        quote! {
            #[doc = " With presliding states, dz/dt = qd - |qd| z/zs, instead of those of sliding."]
            #[inline(always)]
            pub fn with_slip(self, slip: [T; JOINTS]) -> Self {
                State { slip, ..self }
            }
        },
    ]
}
