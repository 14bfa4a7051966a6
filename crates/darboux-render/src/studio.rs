//! The studio that models stand in: lamps and a directional light. studio.json describes it once, for this
//! crate and for the viewer.

use std::sync::LazyLock;

use serde::Deserialize;

/// The number of lamps: `LAMPS` of studio.wgsl.
pub const LAMPS: usize = 6;

static STUDIO: LazyLock<Studio> = LazyLock::new(|| {
    serde_json::from_str(include_str!("studio.json")).expect("studio.json has the members of Studio")
});

/// Environments, of which pictures have the first, and one light.
#[derive(Deserialize)]
pub struct Studio {
    environments: Vec<Environment>,
    pub light: Light,
    /// The yaw in degrees of the camera that the directions are for. The studio turns with cameras at other
    /// sides of the model.
    pub camera_yaw: f64,
    pub ground: GroundLook,
}

/// The look of the ground. Lengths are fractions of half the diagonal of the model's box.
#[derive(Deserialize)]
pub struct GroundLook {
    /// The side of the shadow picture in texels.
    pub texels: usize,
    /// The width of the ground around the model.
    pub margin: f64,
    pub shadows: [Shadow; 2],
    /// The most samples of the surface. A model that needs more has no ground.
    pub most_steps: u64,
}

/// A shadow below the surface of a model.
#[derive(Deserialize)]
pub struct Shadow {
    /// The height above the ground from which the surface casts no shadow.
    pub reach: f64,
    /// The standard deviation of the blur, at most a third of the ground's margin.
    pub blur: f64,
    /// The part of the light that a surface on the ground takes.
    pub darkness: f64,
}

/// Lamps, which a rough surface sees blurred.
#[derive(Deserialize)]
struct Environment {
    lamps: [Lamp; LAMPS],
    /// The radiance from everywhere.
    room: f32,
}

/// A spherical Gaussian.
#[derive(Deserialize)]
struct Lamp {
    /// The direction to the lamp, of any length.
    towards: [f64; 3],
    radiance: f32,
    sharpness: f32,
}

/// A directional light.
#[derive(Deserialize)]
pub struct Light {
    azimuth: f64,
    elevation: f64,
    pub intensity: f32,
}

/// A lamp as the shader takes it.
pub struct ShaderLamp {
    /// The unit direction in the scene.
    pub towards: [f64; 3],
    pub radiance: f32,
    pub sharpness: f32,
}

impl Studio {
    /// The only studio.
    pub fn get() -> &'static Self {
        &STUDIO
    }

    /// The radiance from everywhere.
    pub fn room(&self) -> f32 {
        self.environments[0].room
    }

    /// The lamps for a camera at a yaw in degrees.
    pub fn lamps(&self, camera_yaw: f64) -> [ShaderLamp; LAMPS] {
        [0, 1, 2, 3, 4, 5].map(|at| {
            let Lamp { towards, radiance, sharpness } = self.environments[0].lamps[at];
            ShaderLamp { towards: self.turned(unit(towards), camera_yaw), radiance, sharpness }
        })
    }

    /// The unit direction to the light for a camera at a yaw in degrees.
    pub fn light_direction(&self, camera_yaw: f64) -> [f64; 3] {
        let [azimuth, elevation] = [self.light.azimuth, self.light.elevation].map(f64::to_radians);
        let flat = elevation.cos();
        self.turned([azimuth.sin() * flat, elevation.sin(), azimuth.cos() * flat], camera_yaw)
    }

    /// A direction after the studio has turned with the camera.
    fn turned(&self, [x, y, z]: [f64; 3], camera_yaw: f64) -> [f64; 3] {
        let (sine, cosine) = (camera_yaw - self.camera_yaw).to_radians().sin_cos();
        [x * cosine + z * sine, y, z * cosine - x * sine]
    }
}

fn unit(v: [f64; 3]) -> [f64; 3] {
    let size = v.iter().map(|x| x * x).sum::<f64>().sqrt();
    v.map(|x| x / size)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_light_comes_from_the_right_of_every_camera() {
        let studio = Studio::get();
        for yaw in [-90.0, 0.0, 30.0, 180.0_f64] {
            let [x, y, z] = studio.light_direction(yaw);
            let (sine, cosine) = yaw.to_radians().sin_cos();
            let (right, towards) = (x * cosine - z * sine, x * sine + z * cosine);
            assert!(right > 0.25 && towards > 0.7 && y > 0.5, "{yaw}: {right} {y} {towards}");
        }
        assert!(studio.lamps(0.0).iter().all(|lamp| lamp.radiance > 0.0 && lamp.sharpness > 0.0));
    }
}
