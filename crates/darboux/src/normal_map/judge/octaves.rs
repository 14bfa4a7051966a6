//! Combines the spectra of all halvings of a map into octaves: each wavelength counts once, from the level
//! where it has four to eight texels.

use super::level::Level;
use super::spectrum::{Octave, Spectrum};

/// The octaves of a map, the shortest wavelengths first.
pub fn octaves(levels: &[Level]) -> Vec<Octave> {
    let spectra: Vec<&Spectrum> = levels
        .iter()
        .map_while(|level| level.spectrum.as_ref())
        .filter(|spectrum| spectrum.has_blocks())
        .collect();
    let Some(side) = spectra.first().map(|spectrum| spectrum.side() as f64) else { return Vec::new() };
    let (eighth, quarter) = (side / 8.0, side / 4.0);
    let mut octaves = vec![spectra[0].octave(quarter, f64::INFINITY)];
    octaves.extend(spectra.iter().map(|spectrum| spectrum.octave(eighth, quarter)));
    let coarsest = spectra[spectra.len() - 1];
    octaves.push(coarsest.octave(eighth / 2.0, eighth));
    octaves.push(coarsest.octave(0.0, eighth / 2.0));
    octaves
}
