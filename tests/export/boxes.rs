//! Bodies that stay inside of the shapes of a URDF.

use super::*;

/// An arm of two links with boxes about their middle, `reach` m to either side along the link.
fn urdf(reach: f64) -> String {
    let link = |name: &str, edge: f64| {
        format!(
            "<link name=\"{name}\"><collision><origin xyz=\"0.2 0 0\"/><geometry>\
             <box size=\"{edge} 0.12 0.12\"/></geometry></collision></link>"
        )
    };
    format!(
        "<robot name=\"arm\"><link name=\"base\"/>{}{}\
         <joint name=\"shoulder\" type=\"continuous\"><parent link=\"base\"/><child link=\"upper\"/>\
         <axis xyz=\"0 1 0\"/></joint>\
         <joint name=\"elbow\" type=\"continuous\"><origin xyz=\"0.4 0 0\"/><parent link=\"upper\"/>\
         <child link=\"lower\"/><axis xyz=\"0 1 0\"/></joint></robot>",
        link("upper", 0.5),
        link("lower", 2.0 * reach)
    )
}

fn exported(text: &str) -> Result<Exported, ExportError> {
    let robot = builder::read_texts(&[("arm.urdf", text)]).unwrap();
    // Slender links: 3 kg about 0.2 m, 1 kg about 0.15 m.
    let body = |mass: f64, x: f64, place: usize| {
        let center = &robot.mechanism.joints[place].bodies[0].pose;
        let center = center.translation + center.rotation * nalgebra::Vector3::new(x, 0.0, 0.0);
        Standard::from_values(Pseudo::ball(mass, 0.03, center.into()).values())
    };
    let truth = truth(&robot, &[body(3.0, 0.2, 0), body(1.0, 0.15, 1)]);
    let sigma = vec![Some(1e-3); truth.len()];
    let identified = Identified::new(truth, (&sigma, &sigma), &[]);
    let options = Options {
        fill: true,
        boxes: true,
        total_mass: Some(4.0),
        masses: vec![("lower".into(), 1.0)],
        ..Options::default()
    };
    export(&robot, Some(text), &identified, &options)
}

#[test]
fn bodies_stay_inside_of_the_boxes_of_the_urdf() {
    let found = exported(&urdf(0.25)).unwrap();
    assert!(found.bodies.distance < 4.0, "{}", found.bodies.distance);
    assert!(
        !found
            .warnings
            .iter()
            .any(|warning| warning.contains("no box"))
    );
}

#[test]
fn box_that_the_log_contradicts_is_an_error_with_its_link() {
    // The centre of mass is 0.15 m away from the joint, and the box begins at 0.18 m.
    let refused = exported(&urdf(0.02)).unwrap_err();
    match &refused {
        ExportError::Physical(PhysicalError::Outside { what, .. }) => {
            assert_eq!(what, "what moves with `elbow`", "{refused}");
        }
        other => panic!("{other:?}"),
    }
}

#[test]
fn urdf_without_shapes_has_no_boxes_to_keep() {
    let none = urdf(0.25).replace("<box size", "<mesh filename");
    assert!(matches!(exported(&none), Err(ExportError::NoShapes)));
    let wrong = urdf(0.25).replace("<box size=\"0.5 ", "<box size=\"-0.5 ");
    assert!(matches!(exported(&wrong), Err(ExportError::Shapes(_))));
}
