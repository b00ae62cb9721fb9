//! Generates `arm` from its URDF, again whenever the URDF changes.

fn main() -> Result<(), idim_codegen::BuildError> {
    idim_codegen::Builder::new()
        .robot("robots/arm.urdf")
        .generate()
}
