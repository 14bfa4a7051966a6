# Print an optspec for argparse to handle cmd's options that are independent of any subcommand.
function __fish_darboux_global_optspecs
    string join \n h/help V/version
end

function __fish_darboux_needs_command
    # Figure out if the current invocation already has a command.
    set -l cmd (commandline -opc)
    set -e cmd[1]
    argparse -s (__fish_darboux_global_optspecs) -- $cmd 2>/dev/null
    or return
    if set -q argv[1]
        # Also print the command, so this can be used to figure out what it is.
        echo $argv[1]
        return 1
    end
    return 0
end

function __fish_darboux_using_subcommand
    set -l cmd (__fish_darboux_needs_command)
    test -z "$cmd"
    and return 1
    contains -- $cmd[1] $argv
end

complete -c darboux -n "__fish_darboux_needs_command" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c darboux -n "__fish_darboux_needs_command" -s V -l version -d 'Print version'
complete -c darboux -n "__fish_darboux_needs_command" -f -a "tangents" -d 'Add tangents to models'
complete -c darboux -n "__fish_darboux_needs_command" -f -a "normals" -d 'Add normals to models'
complete -c darboux -n "__fish_darboux_needs_command" -f -a "convert" -d 'Convert normal maps and models between conventions'
complete -c darboux -n "__fish_darboux_needs_command" -f -a "check" -d 'Say what is wrong with models and normal maps'
complete -c darboux -n "__fish_darboux_needs_command" -f -a "report" -d 'Write what is wrong with models as one HTML file with pictures'
complete -c darboux -n "__fish_darboux_needs_command" -f -a "bake" -d 'Bake the detail of high-poly models into maps of a low-poly model'
complete -c darboux -n "__fish_darboux_needs_command" -f -a "compare" -d 'Compare the tangents of two files, or of a file and a method'
complete -c darboux -n "__fish_darboux_needs_command" -f -a "inspect" -d 'Show the contents of each primitive and the difficulties for its tangents'
complete -c darboux -n "__fish_darboux_needs_command" -f -a "render" -d 'Draw a model or its tangents into a PNG'
complete -c darboux -n "__fish_darboux_needs_command" -f -a "view" -d 'Show a model and its tangents in the browser'
complete -c darboux -n "__fish_darboux_needs_command" -f -a "methods" -d 'Explain the methods of computing tangents'
complete -c darboux -n "__fish_darboux_needs_command" -f -a "devices" -d 'List the adapters that can compute tangents'
complete -c darboux -n "__fish_darboux_needs_command" -f -a "completions" -d 'Print the completion script of a shell'
complete -c darboux -n "__fish_darboux_using_subcommand tangents" -s o -l output -d 'Output file for a single input, in an existing folder; - is standard output, as GLB' -r -F
complete -c darboux -n "__fish_darboux_using_subcommand tangents" -l out-dir -d 'Folder for all outputs, created if missing; outputs keep the names of their inputs and the structure of input folders' -r -F
complete -c darboux -n "__fish_darboux_using_subcommand tangents" -l jobs -d 'How many files are processed at the same time; by default one per processor core' -r
complete -c darboux -n "__fish_darboux_using_subcommand tangents" -l memory-limit -d 'The maximum memory for decoding a file, in MiB; by default 256 MiB plus 64 times the size of the file, and at most what the process may use' -r
complete -c darboux -n "__fish_darboux_using_subcommand tangents" -l polygons -d 'How faces of five and more corners are cut, in formats that have them' -r -f -a "blender\t'as Blender cuts them for its exporters'
fan\t'all triangles share the first corner; concave faces are cut into ears'
ears\t'ears are cut off in the order of corners'"
complete -c darboux -n "__fish_darboux_using_subcommand tangents" -l method -d 'How tangents are computed: as the normal map was baked, so nearly always mikktspace' -r -f -a "mikktspace\t'The standard of bakers and engines (Blender, Substance, Marmoset, xNormal, Unity, Unreal, glTF)'
angle-area\t'Weighted by angle and area: follows the UVs most closely, for surfaces without a baked normal map'
lengyel\t'The sum of dP/du, not normalised, separate for each UV orientation'
lengyel-per-vertex\t'The sum of dP/du per vertex, as in three.js and many tutorials: wrong at mirrored seams'
average\t'The mean of the triangles\' tangents, for engines that compute it on the GPU'
area\t'The mean of the triangles\' tangents, weighted by area: large faces dominate'
face\t'One tangent per face, not smoothed: for flat shading and measurements'
from-normal\t'Any direction perpendicular to the normal, independent of UVs: for sampling, not for normal maps'
angle-edge\t'Weighted by angle and edge lengths: the default of meshoptimizer, gltfpack -gt and Godot from 4.6 on'"
complete -c darboux -n "__fish_darboux_using_subcommand tangents" -l mode -d 'Which defects of the MikkTSpace reference implementation are kept' -r -f -a "repaired\t'The bits of the reference where its tangent is usable, a unit tangent elsewhere'
reference\t'The bits of the reference, including zero-length and non-finite tangents'
corrected\t'Like repaired, with all edges matched and one sign per triangle'"
complete -c darboux -n "__fish_darboux_using_subcommand tangents" -l threshold -d 'Split the tangents of faces whose directions differ by this angle or more, in degrees' -r
complete -c darboux -n "__fish_darboux_using_subcommand tangents" -l device -d 'The device that computes the tangents; all devices give the same bits' -r -f -a "auto\t'The CPU, unless DARBOUX_GPU_TRIANGLES is set'
cpu\t'The CPU, with all its cores'
gpu\t'The fastest GPU; a file fails if there is none or if the GPU fails'"
complete -c darboux -n "__fish_darboux_using_subcommand tangents" -l normals -d 'Generate missing normals first: flat, smooth or crease=DEG (smooth except at edges sharper than DEG degrees); keep generates none' -r
complete -c darboux -n "__fish_darboux_using_subcommand tangents" -l encoding -d 'How tangents are stored: f32x4 (16 bytes), snorm16x4 (8 bytes) or snorm8x4 (4 bytes)' -r -f -a "f32x4\t''
snorm16x4\t''
snorm8x4\t''"
complete -c darboux -n "__fish_darboux_using_subcommand tangents" -l in-place -d 'Replace each input by its output'
complete -c darboux -n "__fish_darboux_using_subcommand tangents" -l force -d 'Replace output files that exist'
complete -c darboux -n "__fish_darboux_using_subcommand tangents" -l resume -d 'Process only the inputs whose output in --out-dir is missing or out of date'
complete -c darboux -n "__fish_darboux_using_subcommand tangents" -l retry -d 'With --resume, process also inputs that are skipped because two runs were killed while they worked on them'
complete -c darboux -n "__fish_darboux_using_subcommand tangents" -s v -l verbose -d 'Print every primitive and warning; without it, more than 10 files get one line each'
complete -c darboux -n "__fish_darboux_using_subcommand tangents" -l allow-outside -d 'Allow a glTF\'s buffers and images outside its folder'
complete -c darboux -n "__fish_darboux_using_subcommand tangents" -l overwrite -d 'Replace existing tangents, and with --normals existing normals; without it they are kept'
complete -c darboux -n "__fish_darboux_using_subcommand tangents" -l only-needed -d 'Process only primitives whose material uses tangents (normal map, clearcoat normal map, anisotropy)'
complete -c darboux -n "__fish_darboux_using_subcommand tangents" -l apply-texture-transform -d 'Apply KHR_texture_transform to the UVs first'
complete -c darboux -n "__fish_darboux_using_subcommand tangents" -l strict -d 'Fail for files with non-finite vertex data or with corners that have no usable tangent'
complete -c darboux -n "__fish_darboux_using_subcommand tangents" -l json -d 'Write a report as JSON to standard output'
complete -c darboux -n "__fish_darboux_using_subcommand tangents" -s q -l quiet -d 'Print errors only; commands that write files also print one line with the totals'
complete -c darboux -n "__fish_darboux_using_subcommand tangents" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c darboux -n "__fish_darboux_using_subcommand normals" -s o -l output -d 'Output file for a single input, in an existing folder; - is standard output, as GLB' -r -F
complete -c darboux -n "__fish_darboux_using_subcommand normals" -l out-dir -d 'Folder for all outputs, created if missing; outputs keep the names of their inputs and the structure of input folders' -r -F
complete -c darboux -n "__fish_darboux_using_subcommand normals" -l jobs -d 'How many files are processed at the same time; by default one per processor core' -r
complete -c darboux -n "__fish_darboux_using_subcommand normals" -l memory-limit -d 'The maximum memory for decoding a file, in MiB; by default 256 MiB plus 64 times the size of the file, and at most what the process may use' -r
complete -c darboux -n "__fish_darboux_using_subcommand normals" -l polygons -d 'How faces of five and more corners are cut, in formats that have them' -r -f -a "blender\t'as Blender cuts them for its exporters'
fan\t'all triangles share the first corner; concave faces are cut into ears'
ears\t'ears are cut off in the order of corners'"
complete -c darboux -n "__fish_darboux_using_subcommand normals" -l normals -d 'flat, smooth, or crease=DEG: smooth except at edges sharper than DEG degrees' -r
complete -c darboux -n "__fish_darboux_using_subcommand normals" -l weight -d 'The weight of each face at a smooth vertex' -r -f -a "angle\t'The angle of its corner: independent of the triangulation of flat surfaces'
area\t'Its area'
angle-area\t'Angle times area: wide faces stay flat beside bevels'"
complete -c darboux -n "__fish_darboux_using_subcommand normals" -l in-place -d 'Replace each input by its output'
complete -c darboux -n "__fish_darboux_using_subcommand normals" -l force -d 'Replace output files that exist'
complete -c darboux -n "__fish_darboux_using_subcommand normals" -l resume -d 'Process only the inputs whose output in --out-dir is missing or out of date'
complete -c darboux -n "__fish_darboux_using_subcommand normals" -l retry -d 'With --resume, process also inputs that are skipped because two runs were killed while they worked on them'
complete -c darboux -n "__fish_darboux_using_subcommand normals" -s v -l verbose -d 'Print every primitive and warning; without it, more than 10 files get one line each'
complete -c darboux -n "__fish_darboux_using_subcommand normals" -l allow-outside -d 'Allow a glTF\'s buffers and images outside its folder'
complete -c darboux -n "__fish_darboux_using_subcommand normals" -l respect-seams -d 'Do not smooth across vertices with different indices, even at equal positions'
complete -c darboux -n "__fish_darboux_using_subcommand normals" -l overwrite -d 'Replace existing normals; without it they are kept'
complete -c darboux -n "__fish_darboux_using_subcommand normals" -l json -d 'Write a report as JSON to standard output'
complete -c darboux -n "__fish_darboux_using_subcommand normals" -s q -l quiet -d 'Print errors only; commands that write files also print one line with the totals'
complete -c darboux -n "__fish_darboux_using_subcommand normals" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c darboux -n "__fish_darboux_using_subcommand convert" -l out-dir -d 'Folder for all outputs, created if missing; outputs keep the names of their inputs and the structure of input folders' -r -F
complete -c darboux -n "__fish_darboux_using_subcommand convert" -l jobs -d 'How many files are processed at the same time; by default one per processor core' -r
complete -c darboux -n "__fish_darboux_using_subcommand convert" -l memory-limit -d 'The maximum memory for decoding a file, in MiB; by default 256 MiB plus 64 times the size of the file, and at most what the process may use' -r
complete -c darboux -n "__fish_darboux_using_subcommand convert" -l polygons -d 'How faces of five and more corners are cut, in formats that have them' -r -f -a "blender\t'as Blender cuts them for its exporters'
fan\t'all triangles share the first corner; concave faces are cut into ears'
ears\t'ears are cut off in the order of corners'"
complete -c darboux -n "__fish_darboux_using_subcommand convert" -l from -d 'The convention of the inputs; without it and --to, models are written in another format only' -r -f -a "gltf\t''
opengl\t''
directx\t''
blender\t''
unity\t''
unreal\t''
godot\t''
threejs\t''
maya\t''
3dsmax\t''"
complete -c darboux -n "__fish_darboux_using_subcommand convert" -l to -d 'The convention of the outputs' -r -f -a "gltf\t''
opengl\t''
directx\t''
blender\t''
unity\t''
unreal\t''
godot\t''
threejs\t''
maya\t''
3dsmax\t''"
complete -c darboux -n "__fish_darboux_using_subcommand convert" -l layout -d 'The channels of x, y and, if stored, z of a normal map: rgb, rg, ag, la, ...' -r
complete -c darboux -n "__fish_darboux_using_subcommand convert" -l to-layout -d 'The channels in the output; by default those of --layout. A z that is not stored is computed from x and y' -r
complete -c darboux -n "__fish_darboux_using_subcommand convert" -l space -d 'Convert normal maps to this space from the other one, with the frames of --model' -r -f -a "tangent\t'Tangent space, from an object-space map'
object\t'Object space, from a tangent-space map: the space of the model\'s scene'"
complete -c darboux -n "__fish_darboux_using_subcommand convert" -l model -d 'The model that has the map (.gltf, .glb, .vrm, .obj, .ply, .stl, .fbx), with the tangents of its file, or MikkTSpace\'s' -r -F
complete -c darboux -n "__fish_darboux_using_subcommand convert" -l uv-set -d 'The UV set n of TEXCOORD_n of the model; by default that of the material\'s normal map' -r
complete -c darboux -n "__fish_darboux_using_subcommand convert" -s o -l output -d 'Output file for a single input, in an existing folder; - is standard output' -r -F
complete -c darboux -n "__fish_darboux_using_subcommand convert" -l in-place -d 'Replace each input by its output'
complete -c darboux -n "__fish_darboux_using_subcommand convert" -l force -d 'Replace output files that exist'
complete -c darboux -n "__fish_darboux_using_subcommand convert" -l resume -d 'Process only the inputs whose output in --out-dir is missing or out of date'
complete -c darboux -n "__fish_darboux_using_subcommand convert" -l retry -d 'With --resume, process also inputs that are skipped because two runs were killed while they worked on them'
complete -c darboux -n "__fish_darboux_using_subcommand convert" -s v -l verbose -d 'Print every primitive and warning; without it, more than 10 files get one line each'
complete -c darboux -n "__fish_darboux_using_subcommand convert" -l allow-outside -d 'Allow a glTF\'s buffers and images outside its folder'
complete -c darboux -n "__fish_darboux_using_subcommand convert" -l raw -d 'Allow models in other conventions than glTF\'s, for programs that use the numbers as they are'
complete -c darboux -n "__fish_darboux_using_subcommand convert" -l json -d 'Write a report as JSON to standard output'
complete -c darboux -n "__fish_darboux_using_subcommand convert" -s q -l quiet -d 'Print errors only; commands that write files also print one line with the totals'
complete -c darboux -n "__fish_darboux_using_subcommand convert" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c darboux -n "__fish_darboux_using_subcommand check" -l jobs -d 'How many files are processed at the same time; by default one per processor core' -r
complete -c darboux -n "__fish_darboux_using_subcommand check" -l memory-limit -d 'The maximum memory for decoding a file, in MiB; by default 256 MiB plus 64 times the size of the file, and at most what the process may use' -r
complete -c darboux -n "__fish_darboux_using_subcommand check" -l polygons -d 'How faces of five and more corners are cut, in formats that have them' -r -f -a "blender\t'as Blender cuts them for its exporters'
fan\t'all triangles share the first corner; concave faces are cut into ears'
ears\t'ears are cut off in the order of corners'"
complete -c darboux -n "__fish_darboux_using_subcommand check" -l explain -d 'Print the meaning of a code and exit' -r -f -a "tangent-not-finite\t''
tangent-zero\t''
tangent-not-unit\t''
tangent-not-perpendicular\t''
tangent-sign-not-one\t''
tangent-sign-mixed\t''
tangent-shared-across-mirror\t''
tangent-sign-flipped\t''
tangent-sign-flipped-where-mirrored\t''
tangent-sign-partly-flipped\t''
tangent-rotated\t''
tangent-negated\t''
tangent-other-uv-set\t''
tangent-other-recipe\t''
tangent-missing\t''
tangent-unused\t''
position-not-finite\t''
normal-missing\t''
normal-not-finite\t''
normal-not-unit\t''
normal-against-winding\t''
normal-other-axes\t''
uv-missing\t''
uv-not-finite\t''
uv-degenerate\t''
uv-mirrored\t''
uv-overlapping\t''
uv-stretched\t''
uv-coarse\t''
uv-rounded\t''
uv-hard-edge\t''
map-green-flipped\t''
map-detail-flipped\t''
map-red-flipped\t''
map-may-be-dents\t''
map-channels-swapped\t''
map-srgb\t''
map-height\t''
map-object-space\t''
map-not-normal\t''
map-two-channel\t''
map-not-unit\t''
map-negative-z\t''
map-flat-off\t''
map-flat\t''
map-enlarged\t''
map-banding\t''
map-blocks\t''
map-padding\t''
map-other-layout\t''
conventions-cancel\t''
map-unreadable\t''
map-scale-negative\t''
map-scale-zero\t''
map-scale-extreme\t''
transform-mirrors\t''"
complete -c darboux -n "__fish_darboux_using_subcommand check" -l only -d 'Report these codes only' -r -f -a "tangent-not-finite\t''
tangent-zero\t''
tangent-not-unit\t''
tangent-not-perpendicular\t''
tangent-sign-not-one\t''
tangent-sign-mixed\t''
tangent-shared-across-mirror\t''
tangent-sign-flipped\t''
tangent-sign-flipped-where-mirrored\t''
tangent-sign-partly-flipped\t''
tangent-rotated\t''
tangent-negated\t''
tangent-other-uv-set\t''
tangent-other-recipe\t''
tangent-missing\t''
tangent-unused\t''
position-not-finite\t''
normal-missing\t''
normal-not-finite\t''
normal-not-unit\t''
normal-against-winding\t''
normal-other-axes\t''
uv-missing\t''
uv-not-finite\t''
uv-degenerate\t''
uv-mirrored\t''
uv-overlapping\t''
uv-stretched\t''
uv-coarse\t''
uv-rounded\t''
uv-hard-edge\t''
map-green-flipped\t''
map-detail-flipped\t''
map-red-flipped\t''
map-may-be-dents\t''
map-channels-swapped\t''
map-srgb\t''
map-height\t''
map-object-space\t''
map-not-normal\t''
map-two-channel\t''
map-not-unit\t''
map-negative-z\t''
map-flat-off\t''
map-flat\t''
map-enlarged\t''
map-banding\t''
map-blocks\t''
map-padding\t''
map-other-layout\t''
conventions-cancel\t''
map-unreadable\t''
map-scale-negative\t''
map-scale-zero\t''
map-scale-extreme\t''
transform-mirrors\t''"
complete -c darboux -n "__fish_darboux_using_subcommand check" -l allow -d 'Do not report these codes' -r -f -a "tangent-not-finite\t''
tangent-zero\t''
tangent-not-unit\t''
tangent-not-perpendicular\t''
tangent-sign-not-one\t''
tangent-sign-mixed\t''
tangent-shared-across-mirror\t''
tangent-sign-flipped\t''
tangent-sign-flipped-where-mirrored\t''
tangent-sign-partly-flipped\t''
tangent-rotated\t''
tangent-negated\t''
tangent-other-uv-set\t''
tangent-other-recipe\t''
tangent-missing\t''
tangent-unused\t''
position-not-finite\t''
normal-missing\t''
normal-not-finite\t''
normal-not-unit\t''
normal-against-winding\t''
normal-other-axes\t''
uv-missing\t''
uv-not-finite\t''
uv-degenerate\t''
uv-mirrored\t''
uv-overlapping\t''
uv-stretched\t''
uv-coarse\t''
uv-rounded\t''
uv-hard-edge\t''
map-green-flipped\t''
map-detail-flipped\t''
map-red-flipped\t''
map-may-be-dents\t''
map-channels-swapped\t''
map-srgb\t''
map-height\t''
map-object-space\t''
map-not-normal\t''
map-two-channel\t''
map-not-unit\t''
map-negative-z\t''
map-flat-off\t''
map-flat\t''
map-enlarged\t''
map-banding\t''
map-blocks\t''
map-padding\t''
map-other-layout\t''
conventions-cancel\t''
map-unreadable\t''
map-scale-negative\t''
map-scale-zero\t''
map-scale-extreme\t''
transform-mirrors\t''"
complete -c darboux -n "__fish_darboux_using_subcommand check" -l fail-on -d 'The severity from which on a finding makes the exit code 1' -r -f -a "error\t'A picture is wrong'
warning\t'A picture may be wrong'
never\t'Findings do not change the exit code'"
complete -c darboux -n "__fish_darboux_using_subcommand check" -l convention -d 'Where the green of normal maps should point' -r -f -a "opengl\t'Green up: glTF, OpenGL, Blender, Unity, Godot'
directx\t'Green down: DirectX, Unreal'"
complete -c darboux -n "__fish_darboux_using_subcommand check" -l assume -d 'What normal maps are where neither their texels nor the faces of the model decide it; what the texels show is not overruled' -r -f -a "map=opengl\t'Red points to the right, and green up'
map=directx\t'Green points down'
map=red-inverted\t'Red points to the left'
map=both-inverted\t'Red points to the left and green down, so that bumps are dents'"
complete -c darboux -n "__fish_darboux_using_subcommand check" -l model -d 'The model that the images are normal maps of: its faces tell inverted green from inverted red, and its tangents, normals and UVs are checked, too' -r -F
complete -c darboux -n "__fish_darboux_using_subcommand check" -l method -d 'How --fix makes tangents again: as the normal map was baked, so nearly always mikktspace' -r -f -a "mikktspace\t'The standard of bakers and engines (Blender, Substance, Marmoset, xNormal, Unity, Unreal, glTF)'
angle-area\t'Weighted by angle and area: follows the UVs most closely, for surfaces without a baked normal map'
lengyel\t'The sum of dP/du, not normalised, separate for each UV orientation'
lengyel-per-vertex\t'The sum of dP/du per vertex, as in three.js and many tutorials: wrong at mirrored seams'
average\t'The mean of the triangles\' tangents, for engines that compute it on the GPU'
area\t'The mean of the triangles\' tangents, weighted by area: large faces dominate'
face\t'One tangent per face, not smoothed: for flat shading and measurements'
from-normal\t'Any direction perpendicular to the normal, independent of UVs: for sampling, not for normal maps'
angle-edge\t'Weighted by angle and edge lengths: the default of meshoptimizer, gltfpack -gt and Godot from 4.6 on'"
complete -c darboux -n "__fish_darboux_using_subcommand check" -l normals -d 'How --fix makes missing normals: flat, smooth or crease=DEG' -r
complete -c darboux -n "__fish_darboux_using_subcommand check" -l report -d 'Write what is found as one HTML file with pictures, which needs no network' -r -F
complete -c darboux -n "__fish_darboux_using_subcommand check" -s o -l output -d 'Output file for a single input, in an existing folder; - is standard output, as GLB' -r -F
complete -c darboux -n "__fish_darboux_using_subcommand check" -l out-dir -d 'Folder for all outputs, created if missing; outputs keep the names of their inputs and the structure of input folders' -r -F
complete -c darboux -n "__fish_darboux_using_subcommand check" -l resume -d 'Process only the inputs whose output in --out-dir is missing or out of date'
complete -c darboux -n "__fish_darboux_using_subcommand check" -l retry -d 'With --resume, process also inputs that are skipped because two runs were killed while they worked on them'
complete -c darboux -n "__fish_darboux_using_subcommand check" -s v -l verbose -d 'Print every primitive and warning; without it, more than 10 files get one line each'
complete -c darboux -n "__fish_darboux_using_subcommand check" -l allow-outside -d 'Allow a glTF\'s buffers and images outside its folder'
complete -c darboux -n "__fish_darboux_using_subcommand check" -l no-maps -d 'Do not decode normal maps: they are taken to be right'
complete -c darboux -n "__fish_darboux_using_subcommand check" -l fix -d 'Repair what is found, and write the result'
complete -c darboux -n "__fish_darboux_using_subcommand check" -l dry-run -d 'Print the edits with which --fix would begin, and write no file'
complete -c darboux -n "__fish_darboux_using_subcommand check" -l json -d 'Write a report as JSON to standard output'
complete -c darboux -n "__fish_darboux_using_subcommand check" -s q -l quiet -d 'Print errors only; commands that write files also print one line with the totals'
complete -c darboux -n "__fish_darboux_using_subcommand check" -l in-place -d 'Replace each input by its output'
complete -c darboux -n "__fish_darboux_using_subcommand check" -l force -d 'Replace output files that exist'
complete -c darboux -n "__fish_darboux_using_subcommand check" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c darboux -n "__fish_darboux_using_subcommand report" -s o -l output -d 'The page, in an existing folder' -r -F
complete -c darboux -n "__fish_darboux_using_subcommand report" -l pictures -d 'How many files have pictures: the worst ones' -r
complete -c darboux -n "__fish_darboux_using_subcommand report" -l only -d 'Report these codes only' -r -f -a "tangent-not-finite\t''
tangent-zero\t''
tangent-not-unit\t''
tangent-not-perpendicular\t''
tangent-sign-not-one\t''
tangent-sign-mixed\t''
tangent-shared-across-mirror\t''
tangent-sign-flipped\t''
tangent-sign-flipped-where-mirrored\t''
tangent-sign-partly-flipped\t''
tangent-rotated\t''
tangent-negated\t''
tangent-other-uv-set\t''
tangent-other-recipe\t''
tangent-missing\t''
tangent-unused\t''
position-not-finite\t''
normal-missing\t''
normal-not-finite\t''
normal-not-unit\t''
normal-against-winding\t''
normal-other-axes\t''
uv-missing\t''
uv-not-finite\t''
uv-degenerate\t''
uv-mirrored\t''
uv-overlapping\t''
uv-stretched\t''
uv-coarse\t''
uv-rounded\t''
uv-hard-edge\t''
map-green-flipped\t''
map-detail-flipped\t''
map-red-flipped\t''
map-may-be-dents\t''
map-channels-swapped\t''
map-srgb\t''
map-height\t''
map-object-space\t''
map-not-normal\t''
map-two-channel\t''
map-not-unit\t''
map-negative-z\t''
map-flat-off\t''
map-flat\t''
map-enlarged\t''
map-banding\t''
map-blocks\t''
map-padding\t''
map-other-layout\t''
conventions-cancel\t''
map-unreadable\t''
map-scale-negative\t''
map-scale-zero\t''
map-scale-extreme\t''
transform-mirrors\t''"
complete -c darboux -n "__fish_darboux_using_subcommand report" -l allow -d 'Do not report these codes' -r -f -a "tangent-not-finite\t''
tangent-zero\t''
tangent-not-unit\t''
tangent-not-perpendicular\t''
tangent-sign-not-one\t''
tangent-sign-mixed\t''
tangent-shared-across-mirror\t''
tangent-sign-flipped\t''
tangent-sign-flipped-where-mirrored\t''
tangent-sign-partly-flipped\t''
tangent-rotated\t''
tangent-negated\t''
tangent-other-uv-set\t''
tangent-other-recipe\t''
tangent-missing\t''
tangent-unused\t''
position-not-finite\t''
normal-missing\t''
normal-not-finite\t''
normal-not-unit\t''
normal-against-winding\t''
normal-other-axes\t''
uv-missing\t''
uv-not-finite\t''
uv-degenerate\t''
uv-mirrored\t''
uv-overlapping\t''
uv-stretched\t''
uv-coarse\t''
uv-rounded\t''
uv-hard-edge\t''
map-green-flipped\t''
map-detail-flipped\t''
map-red-flipped\t''
map-may-be-dents\t''
map-channels-swapped\t''
map-srgb\t''
map-height\t''
map-object-space\t''
map-not-normal\t''
map-two-channel\t''
map-not-unit\t''
map-negative-z\t''
map-flat-off\t''
map-flat\t''
map-enlarged\t''
map-banding\t''
map-blocks\t''
map-padding\t''
map-other-layout\t''
conventions-cancel\t''
map-unreadable\t''
map-scale-negative\t''
map-scale-zero\t''
map-scale-extreme\t''
transform-mirrors\t''"
complete -c darboux -n "__fish_darboux_using_subcommand report" -l fail-on -d 'The severity from which on a finding makes the exit code 1' -r -f -a "error\t'A picture is wrong'
warning\t'A picture may be wrong'
never\t'Findings do not change the exit code'"
complete -c darboux -n "__fish_darboux_using_subcommand report" -l convention -d 'Where the green of normal maps should point' -r -f -a "opengl\t'Green up: glTF, OpenGL, Blender, Unity, Godot'
directx\t'Green down: DirectX, Unreal'"
complete -c darboux -n "__fish_darboux_using_subcommand report" -l assume -d 'What normal maps are where neither their texels nor the faces of the model decide it; what the texels show is not overruled' -r -f -a "map=opengl\t'Red points to the right, and green up'
map=directx\t'Green points down'
map=red-inverted\t'Red points to the left'
map=both-inverted\t'Red points to the left and green down, so that bumps are dents'"
complete -c darboux -n "__fish_darboux_using_subcommand report" -l memory-limit -d 'The maximum memory for decoding a file, in MiB; by default 256 MiB plus 64 times the size of the file, and at most what the process may use' -r
complete -c darboux -n "__fish_darboux_using_subcommand report" -l polygons -d 'How faces of five and more corners are cut, in formats that have them' -r -f -a "blender\t'as Blender cuts them for its exporters'
fan\t'all triangles share the first corner; concave faces are cut into ears'
ears\t'ears are cut off in the order of corners'"
complete -c darboux -n "__fish_darboux_using_subcommand report" -l force -d 'Replace the page if it exists'
complete -c darboux -n "__fish_darboux_using_subcommand report" -l no-maps -d 'Do not decode normal maps: they are taken to be right'
complete -c darboux -n "__fish_darboux_using_subcommand report" -l allow-outside -d 'Allow a glTF\'s buffers and images outside its folder'
complete -c darboux -n "__fish_darboux_using_subcommand report" -s q -l quiet -d 'Print errors only'
complete -c darboux -n "__fish_darboux_using_subcommand report" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c darboux -n "__fish_darboux_using_subcommand bake" -l high -d 'The high models (.gltf, .glb, .vrm, .obj, .ply, .stl, .fbx), which have the detail; their materials count, with normal maps and textures' -r -F
complete -c darboux -n "__fish_darboux_using_subcommand bake" -s o -l output -d 'The map (.png, .exr, .tif), in an existing folder; with several maps the name of each is added, as in crate.ao.png, and %UDIM% becomes the number of each tile. Without it the PNG named as the model of --write-model' -r -F
complete -c darboux -n "__fish_darboux_using_subcommand bake" -l map -d 'The maps to bake; several at once share their rays. Without it normal, or material if --write-model stands without -o' -r -f -a "normal\t'Normals in tangent space'
object-normal\t'Normals in the space of the scene'
height\t'The distance of the high surface from the low one; half grey is none'
ao\t'Ambient occlusion: white is open'
position\t'Positions, from 0 to 1 in the box around the high models'
bent-normal\t'The mean of the open directions, in tangent space'
object-bent-normal\t'The mean of the open directions, in the space of the scene'
thickness\t'The mean distance to the other side: black is thin'
curvature\t'Convex is brighter than half grey, concave darker; white curves with the radius of --curvature-radius'
id\t'A colour for each material, mesh or part of the high models'
vertex-color\t'The colours of the high model\'s vertices'
base-color\t'The base colours that the high models show'
opacity\t'The alpha of the base colour, as the alpha mode of the material says'
roughness\t'The roughness of the high models\' materials'
metalness\t'The metalness of the high models\' materials'
emission\t'The light that the high models emit'
texture\t'The texture that --texture names, of the high models\' materials'
world-direction\t'The direction of --world-direction, in tangent space'
uv-islands\t'A colour for each UV chart of the low model'
wireframe\t'White along the edges of the low model\'s triangles'
material\t'The maps of a glTF material: normal, ao, base-color, roughness, metalness and emission'"
complete -c darboux -n "__fish_darboux_using_subcommand bake" -l size -d 'Texels per side, or width and height' -r
complete -c darboux -n "__fish_darboux_using_subcommand bake" -l bits -d 'Bits per channel: 8 or 16 (PNG), 16 or 32 (EXR, TIFF); by default the more for heights, positions and thickness, the fewer for the others' -r
complete -c darboux -n "__fish_darboux_using_subcommand bake" -l dither -d 'Round to 8 bits with blue noise, so that smooth surfaces show no bands; SEED moves the noise' -r
complete -c darboux -n "__fish_darboux_using_subcommand bake" -l pack -d 'Write an image whose channels are maps of one channel each, such as orm=ao,roughness,metalness: OUTPUT with NAME before its ending' -r
complete -c darboux -n "__fish_darboux_using_subcommand bake" -l samples -d 'Samples per texel: 1, 4, 9, 16 and so on up to 256' -r
complete -c darboux -n "__fish_darboux_using_subcommand bake" -l convention -d 'The convention of the maps: directions of red and green, axes of object-space normals and positions' -r -f -a "gltf\t''
opengl\t''
directx\t''
blender\t''
unity\t''
unreal\t''
godot\t''
threejs\t''
maya\t''
3dsmax\t''"
complete -c darboux -n "__fish_darboux_using_subcommand bake" -l padding -d 'Fill texels outside the charts up to this distance only, in texels; without it all are filled' -r
complete -c darboux -n "__fish_darboux_using_subcommand bake" -l ao-rays -d 'Rays per sample of occlusion, bent normals and thickness' -r
complete -c darboux -n "__fish_darboux_using_subcommand bake" -l ao-distance -d 'How far surfaces occlude each other, in the models\' unit; without it any distance' -r
complete -c darboux -n "__fish_darboux_using_subcommand bake" -l ao-falloff -d 'How occlusion fades up to --ao-distance' -r -f -a "none\t'Occlusion does not fade with the distance'
linear\t'It fades evenly up to the greatest distance'
quadratic\t'It fades fast near the surface and slowly far away'"
complete -c darboux -n "__fish_darboux_using_subcommand bake" -l ao-weights -d 'How the directions of occlusion and bent normals are weighted' -r -f -a "cosine\t'By the cosine of the angle to the normal, as light falls on a matte surface'
uniform\t'All directions alike'"
complete -c darboux -n "__fish_darboux_using_subcommand bake" -l thickness-distance -d 'How far the other side is looked for by thickness, in the models\' unit; without it at any distance' -r
complete -c darboux -n "__fish_darboux_using_subcommand bake" -l curvature-radius -d 'The radius in which curvature is measured: texels, as in 4texels, or a distance in the models\' unit' -r
complete -c darboux -n "__fish_darboux_using_subcommand bake" -l id-from -d 'What the colours of an id map stand for' -r -f -a "material\t'A colour for each material'
mesh\t'A colour for each mesh'
part\t'A colour for each part: each node with a mesh'
vertex-color\t'The colours of the vertices themselves'"
complete -c darboux -n "__fish_darboux_using_subcommand bake" -l texture -d 'The texture of the map texture: its place in the JSON of the high models\' materials' -r
complete -c darboux -n "__fish_darboux_using_subcommand bake" -l world-direction -d 'The direction of the map world-direction, along the axes of glTF, where y is up' -r
complete -c darboux -n "__fish_darboux_using_subcommand bake" -l distance -d 'Rays along the interpolated normals: how far outside they begin, and how far inside they end' -r
complete -c darboux -n "__fish_darboux_using_subcommand bake" -l cage-offset -d 'Rays from a cage: the low model, moved outwards by this distance along smooth normals, so that hard edges leave no gaps; they end as far inside' -r
complete -c darboux -n "__fish_darboux_using_subcommand bake" -l cage -d 'Rays from a cage that is a file: the low model with its vertices moved; they end as far inside as --cage-offset says' -r -F
complete -c darboux -n "__fish_darboux_using_subcommand bake" -l auto-cage -d 'Rays from a cage that is made for the models: at every vertex as close as all but a SHARE of the rays around allows, 0.001 by default' -r
complete -c darboux -n "__fish_darboux_using_subcommand bake" -l skew -d 'Turn rays towards the normals of the low model\'s triangles: by an AMOUNT from 0 to 1, or by a painted IMAGE over its UVs, white where rays follow the triangle\'s normal and black where they follow the smooth one' -r
complete -c darboux -n "__fish_darboux_using_subcommand bake" -l max-misses -d 'Fail, and write nothing, if the rays of more than this SHARE of the texels hit nothing; without it they are a warning, unless all miss' -r
complete -c darboux -n "__fish_darboux_using_subcommand bake" -l write-cage -d 'Write the cage as a model, which --cage reads' -r -F
complete -c darboux -n "__fish_darboux_using_subcommand bake" -l match -d 'Which high parts the rays of a low part can hit' -r -f -a "nearest\t'All of them: the first that a ray meets'
name\t'Those of the same name: crate_low gets the detail of crate_high and crate_high_bolts (_lowpoly and _lp mean _low, _highpoly and _hp mean _high). The names of nodes count, or else of meshes'"
complete -c darboux -n "__fish_darboux_using_subcommand bake" -l method -d 'How tangents are computed; by default those of the low model\'s file are used, and mikktspace if it has none for the UV set' -r -f -a "mikktspace\t'The standard of bakers and engines (Blender, Substance, Marmoset, xNormal, Unity, Unreal, glTF)'
angle-area\t'Weighted by angle and area: follows the UVs most closely, for surfaces without a baked normal map'
lengyel\t'The sum of dP/du, not normalised, separate for each UV orientation'
lengyel-per-vertex\t'The sum of dP/du per vertex, as in three.js and many tutorials: wrong at mirrored seams'
average\t'The mean of the triangles\' tangents, for engines that compute it on the GPU'
area\t'The mean of the triangles\' tangents, weighted by area: large faces dominate'
face\t'One tangent per face, not smoothed: for flat shading and measurements'
from-normal\t'Any direction perpendicular to the normal, independent of UVs: for sampling, not for normal maps'
angle-edge\t'Weighted by angle and edge lengths: the default of meshoptimizer, gltfpack -gt and Godot from 4.6 on'"
complete -c darboux -n "__fish_darboux_using_subcommand bake" -l bitangent -d 'How the renderer rebuilds the bitangent' -r -f -a "pixel\t'Per pixel from the interpolated normal and tangent, as glTF, MikkTSpace, Blender, Unreal and Unity'
vertex\t'Per vertex, then interpolated'"
complete -c darboux -n "__fish_darboux_using_subcommand bake" -l uv-set -d 'The UV set n of TEXCOORD_n; by default that of the material\'s normal map' -r
complete -c darboux -n "__fish_darboux_using_subcommand bake" -l material -d 'Bake only the primitives with this material, materials[N] of the low model\'s file; by default all share the map' -r
complete -c darboux -n "__fish_darboux_using_subcommand bake" -l normals -d 'Generate missing normals of the low model first: flat, smooth or crease=DEG; keep generates none' -r
complete -c darboux -n "__fish_darboux_using_subcommand bake" -l write-model -d 'Write the low model with the maps that its materials can have, and with the tangents in its vertices' -r -F
complete -c darboux -n "__fish_darboux_using_subcommand bake" -l heat-map -d 'Draw these errors over the UV layout, with their scale below' -r -F
complete -c darboux -n "__fish_darboux_using_subcommand bake" -l heat-model -d 'Write the low model painted with these errors, unlit, and beside it a PNG of their scale; `darboux render` and every viewer show it' -r -F
complete -c darboux -n "__fish_darboux_using_subcommand bake" -l heat-range -d 'The ends of the scale of errors in degrees; by default those that fit the errors' -r
complete -c darboux -n "__fish_darboux_using_subcommand bake" -l report -d 'Write an HTML page with pictures of the maps, of errors and misses, and of the low model beside the high ones; it loads nothing' -r -F
complete -c darboux -n "__fish_darboux_using_subcommand bake" -l jobs -d 'How many threads work; by default one per processor core' -r
complete -c darboux -n "__fish_darboux_using_subcommand bake" -l memory-limit -d 'The maximum memory for decoding a file, in MiB; by default 256 MiB plus 64 times the size of the file, and at most what the process may use' -r
complete -c darboux -n "__fish_darboux_using_subcommand bake" -l polygons -d 'How faces of five and more corners are cut, in formats that have them' -r -f -a "blender\t'as Blender cuts them for its exporters'
fan\t'all triangles share the first corner; concave faces are cut into ears'
ears\t'ears are cut off in the order of corners'"
complete -c darboux -n "__fish_darboux_using_subcommand bake" -l ao-own-part -d 'Let parts of the high models be occluded by themselves only, not by each other'
complete -c darboux -n "__fish_darboux_using_subcommand bake" -l offset-colors -d 'Multiply the distance of the cage at each vertex by the red of the low model\'s vertex colours'
complete -c darboux -n "__fish_darboux_using_subcommand bake" -l back-faces -d 'Let rays hit triangles from behind'
complete -c darboux -n "__fish_darboux_using_subcommand bake" -l no-high-maps -d 'Bake the geometry of the high models without the normal maps of their materials'
complete -c darboux -n "__fish_darboux_using_subcommand bake" -l verify -d 'Shade the low model with the map that was written, as a renderer does, and print how far its normals are from those of the high models'
complete -c darboux -n "__fish_darboux_using_subcommand bake" -l suffixes -d 'Bake each NAME_low in the folder LOW from NAME_high, with the cage NAME_cage if there is one, into NAME.png in the folder of -o, or in LOW'
complete -c darboux -n "__fish_darboux_using_subcommand bake" -l resume -d 'Skip bakes of a job whose models, options and outputs have not changed since an earlier run; a killed run is continued'
complete -c darboux -n "__fish_darboux_using_subcommand bake" -l retry -d 'With --resume, bake also pairs that are skipped because two runs were killed while they worked on them'
complete -c darboux -n "__fish_darboux_using_subcommand bake" -l force -d 'Replace files that exist'
complete -c darboux -n "__fish_darboux_using_subcommand bake" -l allow-outside -d 'Allow a glTF\'s buffers and images outside its folder'
complete -c darboux -n "__fish_darboux_using_subcommand bake" -l json -d 'Write a report as JSON to standard output'
complete -c darboux -n "__fish_darboux_using_subcommand bake" -s q -l quiet -d 'Print errors only; commands that write files also print one line with the totals'
complete -c darboux -n "__fish_darboux_using_subcommand bake" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c darboux -n "__fish_darboux_using_subcommand compare" -l method -d 'Compare A with the tangents that this method computes for A; `darboux methods` lists the methods' -r -f -a "mikktspace\t'The standard of bakers and engines (Blender, Substance, Marmoset, xNormal, Unity, Unreal, glTF)'
angle-area\t'Weighted by angle and area: follows the UVs most closely, for surfaces without a baked normal map'
lengyel\t'The sum of dP/du, not normalised, separate for each UV orientation'
lengyel-per-vertex\t'The sum of dP/du per vertex, as in three.js and many tutorials: wrong at mirrored seams'
average\t'The mean of the triangles\' tangents, for engines that compute it on the GPU'
area\t'The mean of the triangles\' tangents, weighted by area: large faces dominate'
face\t'One tangent per face, not smoothed: for flat shading and measurements'
from-normal\t'Any direction perpendicular to the normal, independent of UVs: for sampling, not for normal maps'
angle-edge\t'Weighted by angle and edge lengths: the default of meshoptimizer, gltfpack -gt and Godot from 4.6 on'"
complete -c darboux -n "__fish_darboux_using_subcommand compare" -l worst -d 'How many of the worst corners are listed' -r
complete -c darboux -n "__fish_darboux_using_subcommand compare" -l tolerance -d 'Exit with 3 if an angle is larger than this, a sign w is opposite, or one side lacks tangents' -r
complete -c darboux -n "__fish_darboux_using_subcommand compare" -l heat-map -d 'Draw the angles over the UV layout, as a PNG' -r -F
complete -c darboux -n "__fish_darboux_using_subcommand compare" -l memory-limit -d 'The maximum memory for decoding a file, in MiB; by default 256 MiB plus 64 times the size of the file, and at most what the process may use' -r
complete -c darboux -n "__fish_darboux_using_subcommand compare" -l polygons -d 'How faces of five and more corners are cut, in formats that have them' -r -f -a "blender\t'as Blender cuts them for its exporters'
fan\t'all triangles share the first corner; concave faces are cut into ears'
ears\t'ears are cut off in the order of corners'"
complete -c darboux -n "__fish_darboux_using_subcommand compare" -l force -d 'Replace a heat map that exists'
complete -c darboux -n "__fish_darboux_using_subcommand compare" -l allow-outside -d 'Allow a glTF\'s buffers and images outside its folder'
complete -c darboux -n "__fish_darboux_using_subcommand compare" -l json -d 'Write a report as JSON to standard output'
complete -c darboux -n "__fish_darboux_using_subcommand compare" -s q -l quiet -d 'Print errors only; commands that write files also print one line with the totals'
complete -c darboux -n "__fish_darboux_using_subcommand compare" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c darboux -n "__fish_darboux_using_subcommand inspect" -l memory-limit -d 'The maximum memory for decoding a file, in MiB; by default 256 MiB plus 64 times the size of the file, and at most what the process may use' -r
complete -c darboux -n "__fish_darboux_using_subcommand inspect" -l polygons -d 'How faces of five and more corners are cut, in formats that have them' -r -f -a "blender\t'as Blender cuts them for its exporters'
fan\t'all triangles share the first corner; concave faces are cut into ears'
ears\t'ears are cut off in the order of corners'"
complete -c darboux -n "__fish_darboux_using_subcommand inspect" -l allow-outside -d 'Allow a glTF\'s buffers and images outside its folder'
complete -c darboux -n "__fish_darboux_using_subcommand inspect" -l json -d 'Write a report as JSON to standard output'
complete -c darboux -n "__fish_darboux_using_subcommand inspect" -s q -l quiet -d 'Print errors only; commands that write files also print one line with the totals'
complete -c darboux -n "__fish_darboux_using_subcommand inspect" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c darboux -n "__fish_darboux_using_subcommand render" -s o -l output -d 'The picture, in an existing folder' -r -F
complete -c darboux -n "__fish_darboux_using_subcommand render" -l view -d 'What the colours of the surface show' -r -f -a "shaded\t'The surface with its materials in the viewer\'s studio, lit from the upper right'
bumps\t'The same, with test bumps on parts without a normal map, which the file does not have'
tangent\t'Tangents as colours: 0.5 + 0.5 times each component, in scene space'
bitangent\t'Bitangents in the same colours'
normal\t'Normals of the mesh in the same colours'
sign\t'The sign w: blue for 1, orange for -1'
angle\t'The angle between --tangents and --against, from 0.01 to 180 degrees; red with stripes where the signs are opposite'"
complete -c darboux -n "__fish_darboux_using_subcommand render" -l tangents -d 'The source of the tangents: file, derivatives (as shaders without tangents derive them), or a method; `darboux methods` lists the methods' -r
complete -c darboux -n "__fish_darboux_using_subcommand render" -l against -d 'The second source of tangents, for --view angle and for the right side of --split' -r
complete -c darboux -n "__fish_darboux_using_subcommand render" -l split -d 'Divide the picture at this percentage of its width: --tangents on the left; --against, or --mistakes, on the right' -r
complete -c darboux -n "__fish_darboux_using_subcommand render" -l lines -d 'Draw these vectors at the vertices' -r -f -a "tangent\t'Red, unbroken'
bitangent\t'Green, three dashes'
normal\t'Blue, two dashes'"
complete -c darboux -n "__fish_darboux_using_subcommand render" -l length -d 'The length of the lines, in percent of the model\'s radius' -r
complete -c darboux -n "__fish_darboux_using_subcommand render" -l layout -d 'Draw the UV layout in the colours of the surface (in those of the sign for the shaded view), v down' -r -f -a "corner\t'In the lower right corner'
alone\t'Instead of the model'"
complete -c darboux -n "__fish_darboux_using_subcommand render" -l mistakes -d 'Make these mistakes, on the right of --split or in the whole picture' -r -f -a "green\t'Invert the green channel of normal maps'
w\t'Invert the sign w of tangents'
v\t'Sample images at 1 - v'
columns\t'Take the columns of the matrix as tangent, normal, bitangent'
sign-noise\t'Test the sign against the tangent\'s sum'
no-guard\t'Divide by the UV area of triangles without one'
both-negated\t'Negate tangent and bitangent'
uv-not-inverted\t'Use the UV matrix instead of its inverse'
edge-twice\t'Use one edge twice in the bitangent'
without-w\t'Leave w out of the bitangent'
normal-matrix\t'Transform tangents by the normal matrix'
race\t'Let threads lose each other\'s additions'
no-bounds-check\t'Let threads beyond the last vertex write'
adjacency-offsets\t'Use vertex numbers as offsets of adjacency lists'
long-normals\t'Apply Gram-Schmidt with normals of length 10'
one-tangent\t'Give vertices at mirrored seams one tangent'
last-corner\t'Write corners through the old index list'"
complete -c darboux -n "__fish_darboux_using_subcommand render" -l mesh -d 'Draw only this mesh, given by its name or index; can be repeated' -r
complete -c darboux -n "__fish_darboux_using_subcommand render" -l size -d 'Width and height in pixels, at least 1x1' -r
complete -c darboux -n "__fish_darboux_using_subcommand render" -l camera -d 'Degrees around the model (0 is its front), degrees above the horizon, and the magnification (1 shows the whole model)' -r
complete -c darboux -n "__fish_darboux_using_subcommand render" -l look -d 'Where the camera is and what it looks at, as `view=` in a link of the viewer has it; the light comes from where the viewer has it' -r
complete -c darboux -n "__fish_darboux_using_subcommand render" -l background -d 'The colour behind the model' -r
complete -c darboux -n "__fish_darboux_using_subcommand render" -l memory-limit -d 'The maximum memory for decoding a file, in MiB; by default 256 MiB plus 64 times the size of the file, and at most what the process may use' -r
complete -c darboux -n "__fish_darboux_using_subcommand render" -l polygons -d 'How faces of five and more corners are cut, in formats that have them' -r -f -a "blender\t'as Blender cuts them for its exporters'
fan\t'all triangles share the first corner; concave faces are cut into ears'
ears\t'ears are cut off in the order of corners'"
complete -c darboux -n "__fish_darboux_using_subcommand render" -l seams -d 'Draw mirrored seams: the edges across which the sign w changes'
complete -c darboux -n "__fish_darboux_using_subcommand render" -l ground -d 'Stand the lit model on a ground that shows its shadow, as the viewer does'
complete -c darboux -n "__fish_darboux_using_subcommand render" -l no-legend -d 'Draw no legend and no names of the two sides'
complete -c darboux -n "__fish_darboux_using_subcommand render" -l force -d 'Replace a picture that exists'
complete -c darboux -n "__fish_darboux_using_subcommand render" -l allow-outside -d 'Allow a glTF\'s buffers and images outside its folder'
complete -c darboux -n "__fish_darboux_using_subcommand render" -l json -d 'Write a report as JSON to standard output'
complete -c darboux -n "__fish_darboux_using_subcommand render" -s q -l quiet -d 'Print errors only; commands that write files also print one line with the totals'
complete -c darboux -n "__fish_darboux_using_subcommand render" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c darboux -n "__fish_darboux_using_subcommand view" -l high -d 'A high-poly model whose detail the page bakes into a normal map of MODEL' -r -F
complete -c darboux -n "__fish_darboux_using_subcommand view" -l memory-limit -d 'The maximum memory for decoding a file, in MiB; by default 256 MiB plus 64 times the size of the file, and at most what the process may use' -r
complete -c darboux -n "__fish_darboux_using_subcommand view" -l polygons -d 'How faces of five and more corners are cut, in formats that have them' -r -f -a "blender\t'as Blender cuts them for its exporters'
fan\t'all triangles share the first corner; concave faces are cut into ears'
ears\t'ears are cut off in the order of corners'"
complete -c darboux -n "__fish_darboux_using_subcommand view" -l page -d 'The folder with the page\'s files' -r -F
complete -c darboux -n "__fish_darboux_using_subcommand view" -l no-open -d 'Print the address and open no browser'
complete -c darboux -n "__fish_darboux_using_subcommand view" -l allow-outside -d 'Allow a glTF\'s buffers and images outside its folder'
complete -c darboux -n "__fish_darboux_using_subcommand view" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c darboux -n "__fish_darboux_using_subcommand methods" -s h -l help -d 'Print help'
complete -c darboux -n "__fish_darboux_using_subcommand devices" -l json -d 'Print a JSON report to standard output'
complete -c darboux -n "__fish_darboux_using_subcommand devices" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c darboux -n "__fish_darboux_using_subcommand completions" -s h -l help -d 'Print help (see more with \'--help\')'
