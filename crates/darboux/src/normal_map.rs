//! Normal maps: conversion of texels, and the judgement on whole maps.

mod judge;
mod texels;

pub use judge::{MapJudgement, MapTiles, MapVerdict, NormalMapJudge, SrgbMistake, judge_normal_map};
pub use texels::{Channel, TexelLayout, repack_texels};
