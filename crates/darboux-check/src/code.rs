//! [`Code`]: all findings, with their explanations.

use std::fmt;
use std::str::FromStr;

use serde::{Serialize, Serializer};

use crate::severity::Severity;

/// What a repair does with a finding, as a clause.
#[derive(Clone, Copy)]
enum Fix {
    /// What it changes.
    Repair(&'static str),
    /// Why it changes nothing.
    Leave(&'static str),
}

/// What a finding is about.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Family {
    Tangents,
    Positions,
    Normals,
    Uvs,
    Maps,
    Transforms,
}

/// Defines the codes, by family, and their sections from one list: what it means, what it looks like, how it
/// comes about, the cure, and what a repair does.
macro_rules! codes {
    ($([$family:ident] $($code:ident $name:literal $severity:ident { $meaning:literal $looks:literal $cause:literal $cure:literal $fix:ident $clause:literal })*)*) => {
        /// The kind of a finding. The names are stable.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        #[non_exhaustive]
        pub enum Code {
            $($(#[doc = $meaning] $code,)*)*
        }

        impl Code {
            /// All codes, in the order of the documentation.
            pub const ALL: &[Self] = &[$($(Self::$code,)*)*];

            /// The name, such as `tangent-zero`.
            pub fn name(self) -> &'static str {
                match self { $($(Self::$code => $name,)*)* }
            }

            /// What it is about.
            pub(crate) fn family(self) -> Family {
                match self { $($(Self::$code => Family::$family,)*)* }
            }

            /// Whether its findings are about tangents.
            pub fn is_about_tangents(self) -> bool {
                self.family() == Family::Tangents
            }

            /// The usual severity; a finding may have a lower one.
            pub fn severity(self) -> Severity {
                match self { $($(Self::$code => Severity::$severity,)*)* }
            }

            /// What it means, in one sentence.
            pub fn meaning(self) -> &'static str {
                match self { $($(Self::$code => $meaning,)*)* }
            }

            /// What it looks like on screen.
            pub fn looks_like(self) -> &'static str {
                match self { $($(Self::$code => $looks,)*)* }
            }

            /// How it comes about.
            pub fn cause(self) -> &'static str {
                match self { $($(Self::$code => $cause,)*)* }
            }

            /// The cure: what the reader can do, in a modelling program, a baker or with this command.
            pub fn cure(self) -> &'static str {
                match self { $($(Self::$code => $cure,)*)* }
            }

            /// What a repair changes, as a clause; none where it leaves the finding.
            pub fn repair(self) -> Option<&'static str> {
                match self.fix() {
                    Fix::Repair(clause) => Some(clause),
                    Fix::Leave(_) => None,
                }
            }

            /// Why a repair leaves the finding, as a clause; none where it repairs it.
            pub fn left_because(self) -> Option<&'static str> {
                match self.fix() {
                    Fix::Repair(_) => None,
                    Fix::Leave(clause) => Some(clause),
                }
            }

            fn fix(self) -> Fix {
                match self { $($(Self::$code => Fix::$fix($clause),)*)* }
            }
        }
    };
}

codes! {
    [Tangents]
    TangentNotFinite "tangent-not-finite" Error {
        "Tangents contain NaN or infinity."
        "Black or flickering spots, or holes, where the vertex is used."
        "An exporter divided by a UV area of zero."
        "Compute the tangents again: `darboux tangents --overwrite`."
        Repair "these tangents are computed again in the way that the others were"
    }
    TangentZero "tangent-zero" Error {
        "Tangents have length zero."
        "Black spots or NaN in shaders that normalise the tangent; bumps vanish in others."
        "glTF-Transform writes zeros for faces without UV area (its issue 1859); so does the reference code \
         of MikkTSpace."
        "Compute the tangents again: `darboux tangents --overwrite`; the default mode repairs such corners."
        Repair "these tangents are computed again in the way that the others were"
    }
    TangentNotUnit "tangent-not-unit" Error {
        "Tangents do not have length 1."
        "Bumps along u are too strong or too weak in shaders that do not normalise."
        "A scaled node was applied to the tangents, or they were averaged without being normalised."
        "Compute the tangents again: `darboux tangents --overwrite`."
        Repair "these tangents get length 1"
    }
    TangentNotPerpendicular "tangent-not-perpendicular" Error {
        "Tangents lean towards or away from their normals."
        "Bumps are lit from a wrong side, more so at grazing angles."
        "Normals were changed after tangents were computed, for example by smoothing or by weighting."
        "Compute the tangents again: `darboux tangents --overwrite`."
        Repair "these tangents are laid into the planes of their normals"
    }
    TangentSignNotOne "tangent-sign-not-one" Error {
        "The sign w of tangents is neither 1 nor -1."
        "Bumps along v vanish (w = 0) or are scaled."
        "Tangents were exported with three components, or interpolated."
        "Compute the tangents again: `darboux tangents --overwrite`."
        Repair "these signs become those of the UVs"
    }
    TangentSignMixed "tangent-sign-mixed" Warning {
        "Faces have corners with both signs."
        "The bitangent flips within the face: a smeared band."
        "Tangents were computed per vertex on a mesh with mirrored UVs (three.js computeTangents, many \
         tutorials)."
        "Compute the tangents again: `darboux tangents --overwrite` splits the vertices."
        Repair "the wrong signs are negated, and vertices split where their corners need both"
    }
    TangentSharedAcrossMirror "tangent-shared-across-mirror" Error {
        "One vertex serves both sides of a mirrored UV seam, so that it has a wrong tangent on one of them."
        "A line along the middle of the model where every second bump is lit from the wrong side."
        "Tangents of corners were written through the old index list (nvpro-samples/vk_gltf_renderer 33), or \
         computed per vertex."
        "Split the vertices: `darboux tangents --overwrite`."
        Repair "the vertices are split, and the tangents of the other side computed in the way that the rest \
             was"
    }
    TangentSignFlipped "tangent-sign-flipped" Error {
        "The sign w is that of the other convention everywhere."
        "Bumps are lit as if green were inverted: from below instead of from above."
        "The exporter did not negate w for glTF's v axis, which points down, or negated it twice (filament \
         528, three.js 11438)."
        "Compute the tangents again: `darboux tangents --overwrite`."
        Repair "the signs are negated"
    }
    TangentSignFlippedWhereMirrored "tangent-sign-flipped-where-mirrored" Error {
        "The sign w is right on one side of the mirrored UVs and wrong on the other."
        "One half of a mirrored model looks right, the other one is lit from the wrong side."
        "The sign was dropped on the way: all w are equal (assimp 1892)."
        "Compute the tangents again: `darboux tangents --overwrite`."
        Repair "the wrong signs are negated"
    }
    TangentSignPartlyFlipped "tangent-sign-partly-flipped" Error {
        "The sign w is wrong on a part of the surface."
        "Some faces are lit as if green were inverted: their bumps look like dents when the light is above \
         or below."
        "Parts with different conventions were joined, or vertices were merged or moved without their signs."
        "Compute the tangents again: `darboux tangents --overwrite`."
        Repair "the wrong signs are negated"
    }
    TangentRotated "tangent-rotated" Error {
        "Tangents point along v instead of u."
        "Bumps are lit as if the map were turned by 90 degrees."
        "Bitangents were stored as tangents, or u and v were exchanged."
        "Compute the tangents again: `darboux tangents --overwrite`."
        Repair "all tangents of the primitive are computed again by MikkTSpace, or by the method that \
             `--method` names"
    }
    TangentNegated "tangent-negated" Error {
        "Tangents point against u."
        "Bumps are lit from the wrong side along u."
        "The u axis was mirrored after the tangents were computed, or tangents were negated with the \
         handedness."
        "Compute the tangents again: `darboux tangents --overwrite`."
        Repair "these tangents are negated"
    }
    TangentOtherUvSet "tangent-other-uv-set" Error {
        "Tangents follow another UV set than the normal texture."
        "Bumps are lit from directions that change from chart to chart."
        "The exporter computed tangents for the first UV set only (KhronosGroup/glTF 1637)."
        "Compute the tangents again: `darboux tangents --overwrite` takes the set of the normal texture."
        Repair "the tangents are computed again for the UV set of the normal texture"
    }
    TangentOtherRecipe "tangent-other-recipe" Warning {
        "Tangents were computed in another way than MikkTSpace."
        "Smooth shading differs a little from the bake: faint gradients and seams on low-poly models."
        "meshoptimizer's and gltfpack's default weights, three.js computeTangents, averages of an own \
         importer (glTF-Blender-IO 2226)."
        "Keep them if the map was baked with them (`--allow tangent-other-recipe` accepts them); otherwise \
         compute them again: `darboux check FILE --fix --only tangent-other-recipe`."
        Repair "single tangents that no method makes are computed as the others were; all are computed \
             again by MikkTSpace, or by the method that `--method` names, where most, but not all, are \
             MikkTSpace's, or no known method made them and many point to wrong directions; others may be those \
             that the map was baked with, and are computed again only where `--only tangent-other-recipe` or \
             another method asks for it"
    }
    TangentMissing "tangent-missing" Info {
        "The material has a normal map and the primitive has no tangents."
        "Every renderer makes its own tangents; seams and gradients differ from one to the next."
        "The exporter's option for tangents was off."
        "`darboux tangents`."
        Repair "tangents are computed"
    }
    TangentUnused "tangent-unused" Info {
        "Nothing in the material reads the tangents."
        "Nothing; they cost 16 bytes per vertex."
        "The exporter writes tangents always."
        "Leave them out when exporting, if no other material is put on the mesh."
        Leave "another material may need them"
    }
    [Positions]
    PositionNotFinite "position-not-finite" Error {
        "Positions contain NaN or infinity."
        "Faces are missing, or stretch across the picture; the whole model may vanish, because its bounds \
         are not finite."
        "A division by zero in a modifier, a simulation or an exporter."
        "Find these vertices in the modelling program, and delete or move them."
        Leave "where these vertices should be is not in the file"
    }
    [Normals]
    NormalMissing "normal-missing" Info {
        "The primitive has no normals."
        "Renderers draw flat faces."
        "The exporter's option for normals was off, or flat shading is wanted."
        "`darboux normals`, unless flat shading is wanted."
        Repair "normals are computed where a normal map needs tangents"
    }
    NormalNotFinite "normal-not-finite" Error {
        "Normals contain NaN or infinity."
        "Black or flickering spots."
        "An exporter divided by a face area of zero."
        "`darboux normals --overwrite`."
        Repair "normals without a direction are computed from the faces around them"
    }
    NormalNotUnit "normal-not-unit" Warning {
        "Normals do not have length 1."
        "Lighting is too strong or too weak in shaders that do not normalise; black spots where the length \
         is zero."
        "A scaled node was applied to the normals."
        "`darboux normals --overwrite`, or normalise on export."
        Repair "the normals are scaled to length 1; those without a direction are computed from the faces \
             around them"
    }
    NormalAgainstWinding "normal-against-winding" Error {
        "Normals point to the back of their faces."
        "The surface, or a part of it, is dark where it faces the light, or is culled."
        "The model or a part of it was mirrored without reversing its faces, or its faces were reversed \
         without its normals."
        "Recompute normals outside in the modelling program and export again."
        Repair "the corners of the faces are put in the other order where the faces are reversed, and the \
             normals are negated where the normals are"
    }
    NormalOtherAxes "normal-other-axes" Error {
        "Normals are in other axes than the positions."
        "Light comes from a wrong side on all of this part: its top is lit as if it were its front, or its \
         left side as if it were its right one."
        "The positions were turned to another up axis (z to y) or mirrored, and the normals were not."
        "Let `darboux check FILE --fix` turn the normals of this part back, and no others; or apply the \
         rotation and the scale of the object in the modelling program and export again."
        Repair "the components of the normals are exchanged and negated as they fit the faces"
    }
    [Uvs]
    UvMissing "uv-missing" Error {
        "The normal texture uses a UV set that the primitive does not have."
        "The normal map is not shown, or one texel of it is smeared over the surface."
        "The set was removed as unused, or the material was made for another mesh."
        "Export the UV set, or change the texture's texCoord."
        Leave "the UVs are not in the file"
    }
    UvNotFinite "uv-not-finite" Error {
        "UVs contain NaN or infinity."
        "The faces show a random texel, or are black, because their UVs and tangents cannot be computed with."
        "An unwrapping tool or an exporter divided by a length or an area of zero."
        "Unwrap these faces again."
        Leave "UVs are made in a modelling program"
    }
    UvDegenerate "uv-degenerate" Warning {
        "Faces have no area in UV space."
        "The map is smeared to a line on these faces, and their tangents are arbitrary."
        "UVs were not unwrapped there, or were snapped to texels."
        "Unwrap these faces."
        Leave "UVs are made in a modelling program"
    }
    UvMirrored "uv-mirrored" Info {
        "Faces have mirrored UVs."
        "Nothing, if the tangents carry the sign."
        "Texture space was saved by mirroring."
        "None needed."
        Leave "it is no mistake"
    }
    UvOverlapping "uv-overlapping" Info {
        "Faces share UV space with other faces."
        "Nothing, if the same texels are wanted on all of them; otherwise a bake shows the bumps of one part \
         on another."
        "Parts were mirrored or stacked to save texture space, or parts of the unwrapping collided."
        "None needed. For a bake, move all but one of the parts by a whole tile."
        Leave "it is no mistake"
    }
    UvStretched "uv-stretched" Info {
        "UVs stretch the normal map on some faces far more than on the others."
        "Bumps are drawn out to grooves there, and details are smeared along one direction."
        "Faces were moved or scaled after they were unwrapped, or the unwrapping projected them at a flat \
         angle."
        "Unwrap these faces again, or relax their UVs."
        Leave "UVs are made in a modelling program"
    }
    UvCoarse "uv-coarse" Info {
        "Faces get far fewer texels than the others."
        "The normal map is blurred there from close up, beside faces on which it is sharp."
        "Charts were scaled by hand, to save space on what is seldom seen or by mistake."
        "Give these faces larger charts if they are seen from close up."
        Leave "UVs are made in a modelling program"
    }
    UvRounded "uv-rounded" Warning {
        "UVs were rounded to steps so coarse that tangents turn."
        "Bumps wobble: light on them changes from face to face, as if the map were turned a little on each, \
         most visible in reflections on smooth parts."
        "UVs were stored in 8 bits, or in 12 or fewer on a dense mesh (KHR_mesh_quantization, Draco, \
         gltfpack), or written with two or three decimals, before the tangents were computed."
        "Export the UVs with more bits (gltfpack `-vt 16`, Draco's texture coordinates at 14 bits or more, \
         or as floats), or compute the tangents before the UVs are rounded and keep them in the file."
        Leave "the digits that were rounded away are not in the file"
    }
    UvHardEdge "uv-hard-edge" Info {
        "Hard edges have no UV seam."
        "With a map that was baked for the mesh, a thin line along these edges, and a wider one from afar; \
         with one that tiles, nothing."
        "Normals were made hard after the mesh was unwrapped, or edges were marked as sharp and not as seams."
        "Cut the UVs at these edges and leave a gap of some texels, or make the edges smooth and let the map \
         do the rest; then bake again."
        Leave "UVs are made in a modelling program"
    }
    [Maps]
    MapGreenFlipped "map-green-flipped" Error {
        "The normal map's green points the wrong way for the format."
        "Dents look like bumps when the light is above or below, and right when it is beside."
        "A DirectX map was put into glTF, which wants OpenGL's (glTF-Sample-Models PR 336, \
         BabylonJS/Exporters 940, glTF-Blender-IO 2626)."
        "Export or bake the map with green up (OpenGL, +Y), or let `darboux check FILE --fix --assume \
         map=directx` invert its green."
        Repair "green is inverted"
    }
    MapDetailFlipped "map-detail-flipped" Warning {
        "The relief of the normal map is in one convention, and its fine detail in the other."
        "Fine grain looks sunken where it should be raised when the light is above or below; the large \
         shapes are right."
        "A detail map of another convention was laid over the map, or a baked map was mixed with a scanned \
         one."
        "Invert green of the detail map (`darboux check DETAIL --fix --assume map=directx`) and lay it over \
         the map again."
        Leave "relief and detail share their texels, so that no channel can be inverted for one of them"
    }
    MapRedFlipped "map-red-flipped" Error {
        "The normal map's red points the wrong way, judged by the mesh that it was baked for."
        "Dents look like bumps when the light is from the side, and right when it is above or below."
        "The baker was set to -X, or the map was mirrored without inverting red."
        "`darboux check --fix` on the model, or bake again with +X."
        Repair "red is inverted"
    }
    MapMayBeDents "map-may-be-dents" Info {
        "The normal map leans against the faces of the mesh, so that its red and green may both be inverted."
        "Dents look like bumps, whatever side the light comes from; or the map has a dome on every face, and \
         is right."
        "The baker was set to -X and -Y, or the map was turned by 180 degrees; or studs, rivets or cushions \
         lie on the faces."
        "Look at one bump. If it is a dent, type `darboux check FILE --fix --assume map=both-inverted`."
        Leave "a map with bumps on the faces looks the same to every test; `--assume map=both-inverted` says \
             that both channels are inverted, `--assume map=opengl` that the map is right"
    }
    MapChannelsSwapped "map-channels-swapped" Error {
        "Channels of the normal map seem to be exchanged: red and green, or one of them and blue."
        "Bumps are lit as if the map were turned by 90 degrees and mirrored; with blue exchanged, the whole \
         surface is dark or lit from a side."
        "Channels were packed in another order."
        "Let `darboux check FILE --fix` exchange red and green, in a model or in an image alone; or export or \
         bake the map again with x in red and y in green."
        Repair "red and green are exchanged"
    }
    MapSrgb "map-srgb" Error {
        "The normal map's values went through the transfer function of sRGB once too often."
        "The whole surface leans to one side; lighting is too flat or too strong."
        "The map was saved or imported as a colour image (glTFast 67, UnityGLTF 362)."
        "Export the map again as non-colour data (linear, raw)."
        Repair "the texels are decoded from sRGB or encoded, whichever was missed"
    }
    MapHeight "map-height" Error {
        "A grey height or bump map is in the slot of the normal map."
        "The surface leans to one corner everywhere and looks noisy."
        "A bump map was put into the normal slot."
        "Compute a normal map from it (GIMP: Filters, Generic, Normal Map; Blender: a Bump node, then bake), \
         and put that into the slot."
        Leave "how high the bumps are is not in the file, so a normal map has to be made from it first"
    }
    MapObjectSpace "map-object-space" Error {
        "The normal map is in object space."
        "Light comes from a different direction on every side of the model."
        "The baker was set to object or world space."
        "Bake in tangent space."
        Leave "the map has to be baked again"
    }
    MapNotNormal "map-not-normal" Error {
        "The image in the slot of the normal map holds no normals."
        "Lighting does not follow the surface: it is random for a picture, and tilted or black for one \
         colour."
        "Another texture was put into the slot."
        "Put the normal map into the slot, or leave the slot empty if the material has none."
        Leave "the right image is not in the file"
    }
    MapTwoChannel "map-two-channel" Error {
        "The normal map stores x and y only, and the format wants three channels."
        "Where blue is 0 or 128, bumps are far too strong or the surface is black, as z is wrong; where it \
         is 255, they are too weak: by 1 degree where they lean by 20, and by 10 where they lean by 45."
        "The map was packed for an engine that reconstructs z (BC5, DXT5nm)."
        "`darboux convert --from opengl --to opengl --layout rg --to-layout rgb` on the map, with `--layout \
         ag` where x is in alpha (DXT5nm)."
        Repair "blue is computed from red and green"
    }
    MapNotUnit "map-not-unit" Warning {
        "Vectors of the normal map do not have length 1."
        "Lighting is weaker or stronger in renderers that do not normalise, and bumps are too flat or too \
         steep."
        "The map was blended, scaled or resized without being normalised."
        "Normalise the map in the program that made it, or let `darboux check --fix` scale its vectors to \
         length 1."
        Repair "the vectors are scaled to length 1"
    }
    MapNegativeZ "map-negative-z" Warning {
        "Vectors of the normal map point below the surface."
        "Dark or bright specks; where all vectors do, the surface is dark."
        "The map was sharpened, painted on, or baked through the surface (KhronosGroup/glTF 2368); or blue \
         was inverted."
        "Bake again with a fitting cage, or clamp blue to at least 128."
        Leave "where these texels should point is lost"
    }
    MapFlatOff "map-flat-off" Warning {
        "The flat parts of the normal map lean to one side, or the whole map is one colour that leans."
        "A faint seam or gradient between charts, most visible in reflections; with one colour, the whole \
         surface is lit from a wrong side."
        "The flat colour was painted by hand or shifted by a colour profile."
        "Fill flat parts with 128, 128, 255."
        Leave "the surface may lean so on purpose"
    }
    MapFlat "map-flat" Info {
        "The normal map is flat."
        "Nothing; it costs memory."
        "A placeholder was left in."
        "Leave the map out."
        Leave "it makes no picture wrong"
    }
    MapEnlarged "map-enlarged" Warning {
        "The normal map was enlarged without interpolation: every texel is there several times."
        "Light changes in square steps from close up, and the map costs the memory of its size without \
         showing more."
        "The image was resized with nearest-neighbour sampling, as for pixel art, to reach a required size."
        "Use the map in the size that it was made in, bake it in the larger one, or resize it with bicubic \
         interpolation and normalise it."
        Leave "the texels between the ones that are left are not in the file"
    }
    MapBanding "map-banding" Warning {
        "The normal map is stored in few levels per channel."
        "Gentle slopes show bands, most visible in reflections."
        "The image went through a format of 16 bits per texel (R5G6B5), a palette, or a program that reduced \
         its colours."
        "Export the map again with 8 or 16 bits per channel."
        Leave "the levels in between are lost"
    }
    MapBlocks "map-blocks" Warning {
        "The normal map was compressed in blocks so strongly that their borders are in the light."
        "A grid of squares in reflections, and slopes that are smeared or end in steps."
        "The image was saved as JPEG with a low quality, or with a block compression for colours (ETC1S, \
         BC1)."
        "Export the map again as PNG, as JPEG with a quality of 95 and whole colour resolution, or as KTX2 \
         with UASTC."
        Leave "what the compression took is lost"
    }
    MapPadding "map-padding" Warning {
        "The background of the normal map is no normal, and its charts have too little padding for smaller \
         mip levels."
        "Dark or bright lines along UV seams, which become wider and plainer as the model becomes smaller on \
         the screen."
        "The map was baked without padding (margin, dilation), and its background is black, as of bakers \
         that leave what no ray hits empty."
        "Bake again with more padding, such as `darboux bake --padding 16`, or the margin of other bakers."
        Leave "which texels are background is known to the baker: a bake makes the padding in one go"
    }
    MapOtherLayout "map-other-layout" Error {
        "The normal map was made for another UV layout."
        "Details are at wrong places, and seams show; with UVs upside down, the whole texture is."
        "The UVs or the image were mirrored or turned after the bake, as where one program counts v upwards \
         and the next one downwards."
        "Turn the UVs or the image back, or bake the map again for these UVs."
        Leave "nothing says whether the UVs or the image should be turned back, and other textures may use \
             the same UVs"
    }
    ConventionsCancel "conventions-cancel" Warning {
        "The normal map and the tangents are both in the other convention, and the mistakes cancel."
        "Bumps look right in renderers that read the tangents of the file, and like dents in those that \
         compute them."
        "A converter turned the UVs upside down, or wrote tangents for DirectX, and kept the map: from FBX \
         or from Unreal, for example."
        "`darboux check --fix`, which repairs both together, or export the model with the settings for glTF \
         (OpenGL)."
        Repair "the map and the tangents are repaired together"
    }
    MapUnreadable "map-unreadable" Error {
        "The image of the normal map cannot be decoded."
        "The normal map is not shown, or the model does not load."
        "The file is damaged, missing, not fetched by Git LFS, or in a format without a decoder here."
        "Save the image again as PNG, JPEG or WebP."
        Leave "there are no texels to repair"
    }
    MapScaleNegative "map-scale-negative" Warning {
        "The scale of the normal texture is negative, which inverts red and green."
        "Dents look like bumps, whatever side the light comes from, or the map is right and needs this."
        "A slider for the strength of the bumps was pulled below zero, or it was used to turn an inverted \
         map over."
        "Set the scale to its size without the sign, unless the map has both red and green inverted; then \
         invert these and do the same."
        Leave "whether the map needs it is not in the file"
    }
    MapScaleZero "map-scale-zero" Warning {
        "The scale of the normal texture is 0, so that the map does nothing."
        "A smooth surface; the map costs memory."
        "A slider for the strength of the bumps was pulled to 0 to hide them, or an exporter wrote a \
         strength that it did not know as 0."
        "Set the scale to 1, or leave the normal map out."
        Leave "how strong the bumps should be is not in the file"
    }
    MapScaleExtreme "map-scale-extreme" Warning {
        "The scale of the normal texture makes its slopes more than four times as steep."
        "Bumps that are far too strong: gentle slopes look like walls, and noise of the map like gravel."
        "The strength was given in percent or in the units of another program, or it makes up for a map of \
         too gentle slopes."
        "Set the scale to 1, or bake the map with the height that is wanted."
        Leave "how strong the bumps should be is not in the file"
    }
    [Transforms]
    TransformMirrors "transform-mirrors" Warning {
        "KHR_texture_transform turns or mirrors the normal texture."
        "Renderers disagree on whether tangents follow the transformed UVs, so that some light the bumps \
         from a wrong side."
        "The texture was rotated or scaled by a negative number in the material."
        "Apply the transform to the UVs, or see `darboux tangents --apply-texture-transform`."
        Leave "renderers disagree on what is right"
    }
}

impl fmt::Display for Code {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

impl FromStr for Code {
    type Err = String;

    fn from_str(name: &str) -> Result<Self, String> {
        let found = Self::ALL.iter().find(|code| code.name() == name);
        found.copied().ok_or_else(|| format!("no finding has the code {name:?}"))
    }
}

impl Serialize for Code {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.name())
    }
}
