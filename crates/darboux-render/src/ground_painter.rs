//! Draws the ground below a model.

use darboux_gpu::Gpu;
use wgpu::util::{DeviceExt, TextureDataOrder};
use wgpu::{
    BindGroup, BindingResource, FilterMode, RenderPass, RenderPipeline, SamplerDescriptor, TextureDescriptor,
    TextureDimension, TextureFormat, TextureUsages,
};

use crate::drawing::Drawing;
use crate::ground::Ground;
use crate::pipelines::ground_pipeline;
use crate::resources::{color_in, group, uniform};
use crate::studio::Studio;
use crate::subject::Subject;
use crate::uniforms::GroundUniforms;

/// The resources of the ground on the device.
pub struct GroundPainter {
    pipeline: RenderPipeline,
    group: BindGroup,
}

impl GroundPainter {
    /// The ground of a drawing, if it has one. Adds a warning if it should have one, but the model is too
    /// large.
    pub fn of(
        gpu: &Gpu,
        drawing: &Drawing<'_>,
        format: TextureFormat,
        warnings: &mut Vec<String>,
    ) -> Option<Self> {
        if !drawing.options.ground || drawing.subject != Subject::Surface || !drawing.view().is_lit() {
            return None;
        }
        let Some(ground) = Ground::below(&drawing.left.model.parts) else {
            warnings.push("is too large or too small for a ground, so it stands on none".to_owned());
            return None;
        };
        let pipeline = ground_pipeline(gpu, format);
        let background = color_in(drawing.options.background, format);
        let uniforms = uniform(gpu, &GroundUniforms::of(&ground, &drawing.transform, background));
        let side = Studio::get().ground.texels as u32;
        let shadow = TextureDescriptor {
            label: Some("shadow"),
            size: wgpu::Extent3d { width: side, height: side, depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: TextureDimension::D2,
            format: TextureFormat::R8Unorm,
            usage: TextureUsages::TEXTURE_BINDING,
            view_formats: &[],
        };
        let shadow = gpu.device.create_texture_with_data(
            &gpu.queue,
            &shadow,
            TextureDataOrder::default(),
            &ground.texels,
        );
        let sampler = gpu.device.create_sampler(&SamplerDescriptor {
            mag_filter: FilterMode::Linear,
            min_filter: FilterMode::Linear,
            ..Default::default()
        });
        let resources = [
            uniforms.as_entire_binding(),
            BindingResource::TextureView(&shadow.create_view(&Default::default())),
            BindingResource::Sampler(&sampler),
        ];
        let group = group(gpu, &pipeline, 0, &resources);
        Some(Self { pipeline, group })
    }

    pub fn draw(&self, pass: &mut RenderPass<'_>) {
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &self.group, &[]);
        pass.draw(0..4, 0..1);
    }
}
