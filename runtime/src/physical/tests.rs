//! Bodies from estimates that bodies have, and from such that none has.

use super::*;

/// Two links of which the log sees, of each, ZZ + M, MX, MY, and of both together the mass; and a
/// rotor inertia with a friction.
fn problem(truth: &[[f64; 10]; 2], scalars: [f64; 2], precision: f64) -> Problem {
    let mut map = Vec::new();
    for link in 0..2 {
        map.push(vec![(10 * link + 5, 1.0), (10 * link + 9, 0.1)]);
        map.push(vec![(10 * link + 6, 1.0)]);
        map.push(vec![(10 * link + 7, 1.0)]);
    }
    map.push(vec![(9, 1.0), (19, 1.0)]);
    map.push(vec![(20, 1.0), (5, 0.5)]);
    map.push(vec![(21, 1.0)]);
    let unknowns: Vec<f64> = truth.iter().flatten().copied().chain(scalars).collect();
    let np = map.len();
    let row = |row: &Vec<(usize, f64)>| row.iter().map(|(k, f)| f * unknowns[*k]).sum();
    let described = Prior {
        pseudo: Pseudo::ball(1.5, 0.15, [0.1, 0.0, 0.0]),
        mended: false,
    };
    Problem {
        links: vec![described; 2],
        scalars: vec![Scalar::Positive(0.1), Scalar::Free],
        estimate: map.iter().map(row).collect(),
        map,
        precision: (0..np * np)
            .map(|at| if at / np == at % np { precision } else { 0.0 })
            .collect(),
        known: Vec::new(),
        bounds: Vec::new(),
        mirrors: Vec::new(),
        weight: 1e-3,
    }
}

fn bodies() -> [[f64; 10]; 2] {
    let body = |mass, x| Pseudo::ball(mass, 0.12, [x, 0.05, -0.02]).values();
    [body(2.0, 0.2), body(1.0, 0.15)]
}

#[test]
fn estimate_that_bodies_have_is_kept() {
    let problem = problem(&bodies(), [0.05, -0.3], 1e8);
    let found = problem.solve().unwrap();
    assert!(found.links.iter().all(|link| Pseudo::of(link).exists()));
    for (found, estimate) in found.parameters.iter().zip(&problem.estimate) {
        assert!((found - estimate).abs() < 1e-4, "{found} {estimate}");
    }
    assert!(found.distance < 1.0, "{}", found.distance);
    assert!(found.scalars[0] > 0.0);
    assert!((found.scalars[1] + 0.3).abs() < 1e-4);
}

#[test]
fn what_the_data_do_not_see_is_that_of_the_description() {
    let mut silent = problem(&bodies(), [0.05, -0.3], 0.0);
    silent.weight = 1.0;
    let found = silent.solve().unwrap();
    for (link, prior) in found.links.iter().zip(&silent.links) {
        for (a, b) in link.iter().zip(prior.pseudo.values()) {
            assert!((a - b).abs() < 1e-7);
        }
    }
    assert!((found.scalars[0] - 0.1).abs() < 1e-7);
    assert!(found.scalars[1].abs() < 1e-9);
}

#[test]
fn estimate_that_no_body_has_gives_the_nearest_ones() {
    let mut impossible = problem(&bodies(), [0.05, -0.3], 1e6);
    // A negative mass of both together, and a rotor that takes energy.
    impossible.estimate[6] = -0.5;
    impossible.estimate[7] = -0.2;
    let found = impossible.solve().unwrap();
    assert!(found.links.iter().all(|link| Pseudo::of(link).exists()));
    assert!(found.scalars[0] > 0.0);
    assert!(found.distance > 1.0);
    // No bodies are nearer: a smaller weight of the description changes next to nothing.
    impossible.weight = 1e-5;
    let nearer = impossible.solve().unwrap();
    assert!(nearer.distance <= found.distance);
    assert!(nearer.distance > 0.99 * found.distance);
}

#[test]
fn known_mass_is_kept_and_one_that_cannot_be_is_named() {
    let mut known = problem(&bodies(), [0.05, -0.3], 1e6);
    let mass = |value: f64| Known {
        what: "mass of link 1".into(),
        factors: vec![(9, 1.0)],
        value,
        sigma: 1e-4 * value,
    };
    known.known = vec![mass(2.2)];
    let found = known.solve().unwrap();
    assert!((found.links[0][9] - 2.2).abs() < 1e-3);
    // Both together are 3 kg.
    known.known = vec![mass(9.0)];
    match known.solve() {
        Err(PhysicalError::Infeasible { what, nearest, .. }) => {
            assert_eq!(what, "mass of link 1");
            assert!(nearest < 9.0);
        }
        other => panic!("{other:?}"),
    }
    known.known = vec![mass(-1.0)];
    assert!(matches!(known.solve(), Err(PhysicalError::Value { .. })));
}

fn bound(link: usize, center: [f64; 3], half: [f64; 3]) -> Bound {
    Bound {
        what: format!("link {}", link + 1),
        link,
        extent: Extent::upright(center, half),
    }
}

#[test]
fn bodies_stay_inside_of_their_boxes() {
    // The ball described for link 2 reaches out of its box.
    let mut bounded = problem(&bodies(), [0.05, -0.3], 1e6);
    bounded.bounds = vec![
        bound(0, [0.2, 0.05, 0.0], [0.25, 0.2, 0.2]),
        bound(1, [0.15, 0.05, 0.0], [0.25, 0.14, 0.14]),
    ];
    let described = bounded.links[1].pseudo;
    assert!(bounded.bounds[1].extent.room(&described) < 0.0);
    let found = bounded.solve().unwrap();
    for bound in &bounded.bounds {
        let body = Pseudo::of(&found.links[bound.link]);
        assert!(
            body.exists() && bound.extent.room(&body) > 0.0,
            "{}",
            bound.what
        );
    }
    assert!(found.distance < 1.0, "{}", found.distance);
}

#[test]
fn box_that_no_body_is_inside_of_is_named() {
    let mut impossible = problem(&bodies(), [0.05, -0.3], 1e8);
    impossible.bounds = vec![
        bound(0, [0.2, 0.05, 0.0], [0.25, 0.2, 0.2]),
        // Its centre of mass is 0.15 m away from the axis.
        bound(1, [0.0; 3], [0.1; 3]),
    ];
    match impossible.solve() {
        Err(PhysicalError::Outside { what, farther }) => {
            assert_eq!(what, "link 2");
            assert!(farther > 10.0);
        }
        other => panic!("{other:?}"),
    }
    impossible.bounds[1] = bound(1, [0.0; 3], [0.1, -0.1, 0.1]);
    let wrong = impossible.solve();
    assert!(
        matches!(wrong, Err(PhysicalError::Value { .. })),
        "{wrong:?}"
    );
}

#[test]
fn symmetric_link_has_no_products_with_the_normal_of_its_plane() {
    let mut symmetric = problem(&bodies(), [0.05, -0.3], 1e6);
    let free = symmetric.solve().unwrap();
    // z is a direction of which the log sees nothing, y one of which it does.
    let mirror = |normal| Mirror { link: 0, normal };
    symmetric.mirrors = vec![mirror(2)];
    let found = symmetric.solve().unwrap();
    let [_, _, xz, _, yz, _, _, my, mz, _] = found.links[0];
    assert_eq!([xz, yz, mz], [0.0; 3]);
    assert!((my - free.links[0][7]).abs() < 1e-3 && found.distance < 1.0);
    symmetric.mirrors.push(mirror(1));
    let found = symmetric.solve().unwrap();
    let [_, xy, _, _, yz, _, _, my, _, _] = found.links[0];
    assert_eq!([xy, yz, my], [0.0; 3]);
    // Its first moment along y was seen, and is far from zero.
    assert!(found.distance > 100.0);
    assert!(Pseudo::of(&found.links[0]).exists());
    symmetric.mirrors = vec![mirror(3)];
    assert!(matches!(
        symmetric.solve(),
        Err(PhysicalError::Value { .. })
    ));
    symmetric.mirrors = vec![mirror(1)];
    symmetric.bounds = vec![bound(0, [0.2, 0.5, 0.0], [0.25, 0.2, 0.2])];
    assert!(matches!(
        symmetric.solve(),
        Err(PhysicalError::Beside { .. })
    ));
}
