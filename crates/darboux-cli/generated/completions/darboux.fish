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
complete -c darboux -n "__fish_darboux_needs_command" -f -a "tangents" -d 'Add tangents to glTF and GLB files'
complete -c darboux -n "__fish_darboux_needs_command" -f -a "normals" -d 'Add normals to glTF and GLB files'
complete -c darboux -n "__fish_darboux_needs_command" -f -a "convert" -d 'Convert normal maps and models between conventions'
complete -c darboux -n "__fish_darboux_needs_command" -f -a "compare" -d 'Compare the tangents of two files, or of a file and a method'
complete -c darboux -n "__fish_darboux_needs_command" -f -a "inspect" -d 'Show what each primitive holds and what its tangents would meet'
complete -c darboux -n "__fish_darboux_needs_command" -f -a "render" -d 'Draw a model or its tangents into a PNG'
complete -c darboux -n "__fish_darboux_needs_command" -f -a "view" -d 'Show a model in the browser, with its tangents'
complete -c darboux -n "__fish_darboux_needs_command" -f -a "methods" -d 'Say which method of computing tangents is for what'
complete -c darboux -n "__fish_darboux_needs_command" -f -a "devices" -d 'List the adapters that can compute tangents'
complete -c darboux -n "__fish_darboux_using_subcommand tangents" -s o -l output -d 'Output file for a single input, in a folder that exists; - is standard output, as GLB' -r -F
complete -c darboux -n "__fish_darboux_using_subcommand tangents" -l out-dir -d 'Folder for all outputs, made if missing; they have the names of their inputs, and an input folder\'s structure is kept' -r -F
complete -c darboux -n "__fish_darboux_using_subcommand tangents" -l jobs -d 'How many files are worked on at the same time' -r
complete -c darboux -n "__fish_darboux_using_subcommand tangents" -l memory-limit -d 'The most memory that a file may ask for; without it, 256 MiB and 64 times the size of the file' -r
complete -c darboux -n "__fish_darboux_using_subcommand tangents" -l method -d 'How tangents are computed: as the normal map was baked, so nearly always mikktspace' -r -f -a "mikktspace\t'The standard of bakers and engines'
angle-area\t'Weighted by angle and area: follows the UVs best where no baked map asks for MikkTSpace'
lengyel\t'Sums of dP/du, one per UV orientation'
lengyel-per-vertex\t'Sums of dP/du, one per vertex, as three.js and many tutorials: breaks mirrored seams'
average\t'Mean of the triangles\' tangents'
area\t'Mean weighted by area'
face\t'Each face its own: exact, not smooth'
from-normal\t'Any perpendicular of the normal; needs no UVs, and says nothing about them'"
complete -c darboux -n "__fish_darboux_using_subcommand tangents" -l mode -d 'Which defects of the MikkTSpace reference to keep' -r -f -a "reference\t'Every bit of the reference, zero-length and non-finite tangents included'
repaired\t'The reference\'s bits where they are usable, a unit tangent elsewhere'
corrected\t'As repaired, with all edges matched and one sign per triangle'"
complete -c darboux -n "__fish_darboux_using_subcommand tangents" -l threshold -d 'Split tangents of faces whose directions differ by this many degrees or more' -r
complete -c darboux -n "__fish_darboux_using_subcommand tangents" -l device -d 'What computes the tangents: the bits are the same' -r -f -a "auto\t'The quicker one, as far as was measured: the CPU'
cpu\t'The CPU, on all its threads'
gpu\t'The fastest adapter; without one, or where it fails, files fail'"
complete -c darboux -n "__fish_darboux_using_subcommand tangents" -l normals -d 'keep normals as they are, or first make those that are missing: flat, smooth or crease=DEG' -r
complete -c darboux -n "__fish_darboux_using_subcommand tangents" -l encoding -d 'How tangents are stored: f32x4 (16 bytes), snorm16x4 (8) or snorm8x4 (4)' -r -f -a "f32x4\t''
snorm16x4\t''
snorm8x4\t''"
complete -c darboux -n "__fish_darboux_using_subcommand tangents" -l in-place -d 'Replace each input by its output'
complete -c darboux -n "__fish_darboux_using_subcommand tangents" -l force -d 'Replace output files that exist'
complete -c darboux -n "__fish_darboux_using_subcommand tangents" -l resume -d 'Leave out inputs whose output in --out-dir is up to date, and replace those that are not'
complete -c darboux -n "__fish_darboux_using_subcommand tangents" -l allow-outside -d 'Allow a glTF\'s buffers and images outside its folder'
complete -c darboux -n "__fish_darboux_using_subcommand tangents" -l overwrite -d 'Replace tangents that exist, and with --normals normals; without it such primitives are kept'
complete -c darboux -n "__fish_darboux_using_subcommand tangents" -l only-needed -d 'Only primitives whose material uses tangents (normal map, clearcoat normal map, anisotropy)'
complete -c darboux -n "__fish_darboux_using_subcommand tangents" -l apply-texture-transform -d 'Apply KHR_texture_transform to the UVs first'
complete -c darboux -n "__fish_darboux_using_subcommand tangents" -l strict -d 'Refuse files with non-finite vertex data or corners that have no usable tangent'
complete -c darboux -n "__fish_darboux_using_subcommand tangents" -l json -d 'Write a report as JSON to standard output'
complete -c darboux -n "__fish_darboux_using_subcommand tangents" -s q -l quiet -d 'Print errors only'
complete -c darboux -n "__fish_darboux_using_subcommand tangents" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c darboux -n "__fish_darboux_using_subcommand normals" -s o -l output -d 'Output file for a single input, in a folder that exists; - is standard output, as GLB' -r -F
complete -c darboux -n "__fish_darboux_using_subcommand normals" -l out-dir -d 'Folder for all outputs, made if missing; they have the names of their inputs, and an input folder\'s structure is kept' -r -F
complete -c darboux -n "__fish_darboux_using_subcommand normals" -l jobs -d 'How many files are worked on at the same time' -r
complete -c darboux -n "__fish_darboux_using_subcommand normals" -l memory-limit -d 'The most memory that a file may ask for; without it, 256 MiB and 64 times the size of the file' -r
complete -c darboux -n "__fish_darboux_using_subcommand normals" -l normals -d 'flat, smooth, or crease=DEG: smooth but for edges that are sharper than so many degrees' -r
complete -c darboux -n "__fish_darboux_using_subcommand normals" -l weight -d 'How much each face counts at a vertex of a smooth surface' -r -f -a "angle\t'The angle of its corner: independent of how a flat surface is cut'
area\t'Its area'
angle-area\t'Both: wide faces stay flat beside bevels'"
complete -c darboux -n "__fish_darboux_using_subcommand normals" -l in-place -d 'Replace each input by its output'
complete -c darboux -n "__fish_darboux_using_subcommand normals" -l force -d 'Replace output files that exist'
complete -c darboux -n "__fish_darboux_using_subcommand normals" -l resume -d 'Leave out inputs whose output in --out-dir is up to date, and replace those that are not'
complete -c darboux -n "__fish_darboux_using_subcommand normals" -l allow-outside -d 'Allow a glTF\'s buffers and images outside its folder'
complete -c darboux -n "__fish_darboux_using_subcommand normals" -l respect-seams -d 'Vertices stay apart where the index list has them apart, at equal positions too'
complete -c darboux -n "__fish_darboux_using_subcommand normals" -l overwrite -d 'Replace normals that exist; without it such primitives are kept'
complete -c darboux -n "__fish_darboux_using_subcommand normals" -l json -d 'Write a report as JSON to standard output'
complete -c darboux -n "__fish_darboux_using_subcommand normals" -s q -l quiet -d 'Print errors only'
complete -c darboux -n "__fish_darboux_using_subcommand normals" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c darboux -n "__fish_darboux_using_subcommand convert" -l out-dir -d 'Folder for all outputs, made if missing; they have the names of their inputs, and an input folder\'s structure is kept' -r -F
complete -c darboux -n "__fish_darboux_using_subcommand convert" -l jobs -d 'How many files are worked on at the same time' -r
complete -c darboux -n "__fish_darboux_using_subcommand convert" -l memory-limit -d 'The most memory that a file may ask for; without it, 256 MiB and 64 times the size of the file' -r
complete -c darboux -n "__fish_darboux_using_subcommand convert" -l from -d 'The convention that the files are in' -r -f -a "gltf\t''
opengl\t''
directx\t''
blender\t''
unity\t''
unreal\t''
godot\t''
threejs\t''
maya\t''
3dsmax\t''"
complete -c darboux -n "__fish_darboux_using_subcommand convert" -l to -d 'The convention that they shall be in' -r -f -a "gltf\t''
opengl\t''
directx\t''
blender\t''
unity\t''
unreal\t''
godot\t''
threejs\t''
maya\t''
3dsmax\t''"
complete -c darboux -n "__fish_darboux_using_subcommand convert" -l layout -d 'Channels of a normal map\'s x, y and, where it is stored, z, in this order: rgb, rg, ag, la, ...' -r
complete -c darboux -n "__fish_darboux_using_subcommand convert" -l to-layout -d 'Channels that they shall be in; the same unless given. A z that was not stored is rebuilt' -r
complete -c darboux -n "__fish_darboux_using_subcommand convert" -s o -l output -d 'Output file for a single input, in a folder that exists; - is standard output' -r -F
complete -c darboux -n "__fish_darboux_using_subcommand convert" -l in-place -d 'Replace each input by its output'
complete -c darboux -n "__fish_darboux_using_subcommand convert" -l force -d 'Replace output files that exist'
complete -c darboux -n "__fish_darboux_using_subcommand convert" -l resume -d 'Leave out inputs whose output in --out-dir is up to date, and replace those that are not'
complete -c darboux -n "__fish_darboux_using_subcommand convert" -l allow-outside -d 'Allow a glTF\'s buffers and images outside its folder'
complete -c darboux -n "__fish_darboux_using_subcommand convert" -l raw -d 'Let a model leave glTF\'s convention: for programs that copy its numbers as they are'
complete -c darboux -n "__fish_darboux_using_subcommand convert" -l json -d 'Write a report as JSON to standard output'
complete -c darboux -n "__fish_darboux_using_subcommand convert" -s q -l quiet -d 'Print errors only'
complete -c darboux -n "__fish_darboux_using_subcommand convert" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c darboux -n "__fish_darboux_using_subcommand compare" -l method -d 'Compare A with the tangents that this method gives it; `darboux methods` lists them' -r -f -a "mikktspace\t'The standard of bakers and engines'
angle-area\t'Weighted by angle and area: follows the UVs best where no baked map asks for MikkTSpace'
lengyel\t'Sums of dP/du, one per UV orientation'
lengyel-per-vertex\t'Sums of dP/du, one per vertex, as three.js and many tutorials: breaks mirrored seams'
average\t'Mean of the triangles\' tangents'
area\t'Mean weighted by area'
face\t'Each face its own: exact, not smooth'
from-normal\t'Any perpendicular of the normal; needs no UVs, and says nothing about them'"
complete -c darboux -n "__fish_darboux_using_subcommand compare" -l worst -d 'How many of the worst places are listed' -r
complete -c darboux -n "__fish_darboux_using_subcommand compare" -l tolerance -d 'Exit with 3 if an angle is greater than so many degrees, a sign is flipped, or tangents are missing on one side' -r
complete -c darboux -n "__fish_darboux_using_subcommand compare" -l heat-map -d 'Draw the angles over the UV layout, as a PNG' -r -F
complete -c darboux -n "__fish_darboux_using_subcommand compare" -l memory-limit -d 'The most memory that a file may ask for; without it, 256 MiB and 64 times the size of the file' -r
complete -c darboux -n "__fish_darboux_using_subcommand compare" -l force -d 'Replace a heat map that exists'
complete -c darboux -n "__fish_darboux_using_subcommand compare" -l allow-outside -d 'Allow a glTF\'s buffers and images outside its folder'
complete -c darboux -n "__fish_darboux_using_subcommand compare" -l json -d 'Write a report as JSON to standard output'
complete -c darboux -n "__fish_darboux_using_subcommand compare" -s q -l quiet -d 'Print errors only'
complete -c darboux -n "__fish_darboux_using_subcommand compare" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c darboux -n "__fish_darboux_using_subcommand inspect" -l memory-limit -d 'The most memory that a file may ask for; without it, 256 MiB and 64 times the size of the file' -r
complete -c darboux -n "__fish_darboux_using_subcommand inspect" -l allow-outside -d 'Allow a glTF\'s buffers and images outside its folder'
complete -c darboux -n "__fish_darboux_using_subcommand inspect" -l json -d 'Write a report as JSON to standard output'
complete -c darboux -n "__fish_darboux_using_subcommand inspect" -s q -l quiet -d 'Print errors only'
complete -c darboux -n "__fish_darboux_using_subcommand inspect" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c darboux -n "__fish_darboux_using_subcommand render" -s o -l output -d 'The picture' -r -F
complete -c darboux -n "__fish_darboux_using_subcommand render" -l view -d 'What the surface is painted with' -r -f -a "shaded\t'The surface with its base colour and normal map, lit from above right'
tangent\t'Tangents as colours, 0.5 + 0.5 of each component in the scene'
bitangent\t'Bitangents, likewise'
normal\t'Normals of the mesh, likewise'
sign\t'The sign w: blue 1, orange -1'
angle\t'The angle between --tangents and --against, from 0.01 to 180 degrees; red where signs differ'"
complete -c darboux -n "__fish_darboux_using_subcommand render" -l tangents -d 'Whose tangents: file, derivatives (what shaders do that have none), or a method, as `darboux methods` lists them' -r
complete -c darboux -n "__fish_darboux_using_subcommand render" -l against -d 'The other tangents: what --view angle compares with, and what --split shows on the right' -r
complete -c darboux -n "__fish_darboux_using_subcommand render" -l split -d 'Show --tangents left of so many percent of the width, and --against right of them; or the same there, with --mistakes' -r
complete -c darboux -n "__fish_darboux_using_subcommand render" -l lines -d 'Draw these vectors at the vertices' -r -f -a "tangent\t'Red'
bitangent\t'Green'
normal\t'Blue'"
complete -c darboux -n "__fish_darboux_using_subcommand render" -l length -d 'Length of lines, in percent of the model\'s radius' -r
complete -c darboux -n "__fish_darboux_using_subcommand render" -l layout -d 'Draw the UV layout in the surface\'s colours (signs where it is shaded), v down' -r -f -a "corner\t'Over the lower right corner'
alone\t'In place of the model'"
complete -c darboux -n "__fish_darboux_using_subcommand render" -l mistakes -d 'Do this wrong; right of --split, or everywhere' -r -f -a "green\t'Flip the normal map\'s green channel'
w\t'Flip the sign of tangents'
v\t'Sample images at 1 - v'"
complete -c darboux -n "__fish_darboux_using_subcommand render" -l mesh -d 'Draw this mesh alone: its name, or else its index; several times for several' -r
complete -c darboux -n "__fish_darboux_using_subcommand render" -l size -d 'Pixels across and down' -r
complete -c darboux -n "__fish_darboux_using_subcommand render" -l camera -d 'Degrees around the model (0 is its front), degrees above the horizon, and how many times nearer than all of it in view' -r
complete -c darboux -n "__fish_darboux_using_subcommand render" -l background -d 'The colour behind the model' -r
complete -c darboux -n "__fish_darboux_using_subcommand render" -l memory-limit -d 'The most memory that a file may ask for; without it, 256 MiB and 64 times the size of the file' -r
complete -c darboux -n "__fish_darboux_using_subcommand render" -l seams -d 'Draw the edges across which the sign changes: where a texture meets its mirror image'
complete -c darboux -n "__fish_darboux_using_subcommand render" -l no-legend -d 'Leave out what explains the colours, and the names of both sides'
complete -c darboux -n "__fish_darboux_using_subcommand render" -l force -d 'Replace a picture that exists'
complete -c darboux -n "__fish_darboux_using_subcommand render" -l allow-outside -d 'Allow a glTF\'s buffers and images outside its folder'
complete -c darboux -n "__fish_darboux_using_subcommand render" -l json -d 'Write a report as JSON to standard output'
complete -c darboux -n "__fish_darboux_using_subcommand render" -s q -l quiet -d 'Print errors only'
complete -c darboux -n "__fish_darboux_using_subcommand render" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c darboux -n "__fish_darboux_using_subcommand view" -l memory-limit -d 'The most memory that a file may ask for; without it, 256 MiB and 64 times the size of the file' -r
complete -c darboux -n "__fish_darboux_using_subcommand view" -l page -d 'The folder with the page\'s files' -r -F
complete -c darboux -n "__fish_darboux_using_subcommand view" -l no-open -d 'Print the address and open no browser'
complete -c darboux -n "__fish_darboux_using_subcommand view" -l allow-outside -d 'Allow a glTF\'s buffers and images outside its folder'
complete -c darboux -n "__fish_darboux_using_subcommand view" -s h -l help -d 'Print help (see more with \'--help\')'
complete -c darboux -n "__fish_darboux_using_subcommand methods" -s h -l help -d 'Print help'
complete -c darboux -n "__fish_darboux_using_subcommand devices" -l json -d 'Print a JSON report to standard output'
complete -c darboux -n "__fish_darboux_using_subcommand devices" -s h -l help -d 'Print help (see more with \'--help\')'
