//! Effects of a given strength that a description can ask for.

use idim::codegen::catalogue::EffectKind;

use super::hidden::{Column, Hidden};
use super::host::Host;
use super::random::Random;
use super::robots::Rating;

/// Effects that a description can ask for.
pub fn columns(
    name: &str,
    joint: usize,
    s: f64,
    host: &Host,
    random: &mut Random,
) -> Option<(Vec<usize>, Hidden)> {
    let rating = host.ratings[joint];
    let coulomb = host.coulomb[joint];
    let size = s * random.uniform(0.6, 1.4);
    let one = |kind, shape: Vec<f64>, values: Vec<(&'static str, f64)>| {
        let column = Column {
            kind,
            joints: vec![joint],
            shape,
            values,
        };
        Some((vec![joint], Hidden::Columns(vec![column])))
    };
    let phase = random.uniform(0.0, std::f64::consts::TAU);
    let signed = size * random.sign();
    match name {
        "torque_offset" => one(
            EffectKind::Offset,
            vec![],
            vec![("OFF", 0.022 * signed * rating.scale)],
        ),
        "viscous_asymmetry" => {
            let value = 0.035 * signed * rating.scale / rating.speed;
            one(EffectKind::ViscousAsymmetry, vec![], vec![("FVA", value)])
        }
        "stribeck" => {
            let velocity = rating.speed * random.ratio(0.03, 0.25);
            one(
                EffectKind::Stribeck,
                vec![velocity],
                vec![("FST", 0.8 * size * coulomb)],
            )
        }
        "nonlinear_viscous" => {
            let p = random.uniform(1.6, 3.2);
            let value = 0.07 * size * rating.scale / rating.speed.powf(p);
            one(EffectKind::NonlinearViscous, vec![p], vec![("FVN", value)])
        }
        "position_dependent_friction" if !rating.slides => {
            let (n, level) = (random.whole(1, 4) as f64, (0.4 * size).min(0.9) * coulomb);
            let values = vec![("FPS", level * phase.cos()), ("FPC", level * phase.sin())];
            one(EffectKind::PositionDependentFriction, vec![n], values)
        }
        "torque_ripple" if !rating.slides => {
            let (n, level) = (random.whole(2, 20) as f64, 0.016 * size * rating.scale);
            let values = vec![("RS", level * phase.cos()), ("RC", level * phase.sin())];
            one(EffectKind::TorqueRipple, vec![n], values)
        }
        "spring" => spring(joint, size, rating, random),
        "end_stop" => {
            let (low, high) = host.range[joint];
            let side = random.sign();
            let deep = random.uniform(0.12, 0.3) * (high - low);
            let at = if side > 0.0 { high - deep } else { low + deep };
            let value = 0.1 * size * rating.scale / deep;
            one(EffectKind::EndStop, vec![at, side], vec![("KE", value)])
        }
        "transmission_coupling" => coupling(size, host, random),
        "presliding" => {
            let zs = (0.012 * size).clamp(0.002, 0.08);
            one(EffectKind::Presliding, vec![zs], vec![("FP", coulomb)])
        }
        _ => None,
    }
}

fn spring(
    joint: usize,
    size: f64,
    rating: Rating,
    random: &mut Random,
) -> Option<(Vec<usize>, Hidden)> {
    let stiffness = 0.05 * size * rating.scale / rating.reach;
    let rest = rating.center + rating.reach * random.uniform(-0.5, 0.5);
    let column = |kind, symbol, value| Column {
        kind,
        joints: vec![joint],
        shape: vec![],
        values: vec![(symbol, value)],
    };
    let pulls = column(EffectKind::Spring, "K", stiffness);
    let offset = column(EffectKind::Offset, "OFF", -stiffness * rest);
    Some((vec![joint], Hidden::Columns(vec![pulls, offset])))
}

/// Two turning neighbours among the last three joints.
fn coupling(size: f64, host: &Host, random: &mut Random) -> Option<(Vec<usize>, Hidden)> {
    let last = host.ratings.len() - 1;
    let first = random.whole(last.saturating_sub(2), last - 1);
    let joints = vec![first, first + 1];
    if joints.iter().any(|&joint| host.ratings[joint].slides) {
        return None;
    }
    let column = Column {
        kind: EffectKind::TransmissionCoupling,
        joints: joints.clone(),
        shape: vec![random.sign()],
        values: vec![
            ("FSX", 0.5 * size * host.coulomb[first + 1]),
            ("FVX", 0.4 * size * host.viscous[first + 1]),
        ],
    };
    Some((joints, Hidden::Columns(vec![column])))
}
