//! The examples for other crates' vectors run.

#[path = "../examples/glam.rs"]
mod glam_example;
#[path = "../examples/mint.rs"]
mod mint_example;
#[path = "../examples/nalgebra.rs"]
mod nalgebra_example;

#[test]
fn examples_run() -> Result<(), darboux::Error> {
    glam_example::main()?;
    mint_example::main()?;
    nalgebra_example::main()
}
