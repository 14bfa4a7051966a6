
using namespace System.Management.Automation
using namespace System.Management.Automation.Language

Register-ArgumentCompleter -Native -CommandName 'darboux' -ScriptBlock {
    param($wordToComplete, $commandAst, $cursorPosition)

    $commandElements = $commandAst.CommandElements
    $command = @(
        'darboux'
        for ($i = 1; $i -lt $commandElements.Count; $i++) {
            $element = $commandElements[$i]
            if ($element -isnot [StringConstantExpressionAst] -or
                $element.StringConstantType -ne [StringConstantType]::BareWord -or
                $element.Value.StartsWith('-') -or
                $element.Value -eq $wordToComplete) {
                break
        }
        $element.Value
    }) -join ';'

    $completions = @(switch ($command) {
        'darboux' {
            [CompletionResult]::new('-h', '-h', [CompletionResultType]::ParameterName, 'Print help (see more with ''--help'')')
            [CompletionResult]::new('--help', '--help', [CompletionResultType]::ParameterName, 'Print help (see more with ''--help'')')
            [CompletionResult]::new('-V', '-V ', [CompletionResultType]::ParameterName, 'Print version')
            [CompletionResult]::new('--version', '--version', [CompletionResultType]::ParameterName, 'Print version')
            [CompletionResult]::new('tangents', 'tangents', [CompletionResultType]::ParameterValue, 'Add tangents to models')
            [CompletionResult]::new('normals', 'normals', [CompletionResultType]::ParameterValue, 'Add normals to models')
            [CompletionResult]::new('convert', 'convert', [CompletionResultType]::ParameterValue, 'Convert normal maps and models between conventions')
            [CompletionResult]::new('check', 'check', [CompletionResultType]::ParameterValue, 'Say what is wrong with models and normal maps')
            [CompletionResult]::new('report', 'report', [CompletionResultType]::ParameterValue, 'Write what is wrong with models as one HTML file with pictures')
            [CompletionResult]::new('bake', 'bake', [CompletionResultType]::ParameterValue, 'Bake the detail of high-poly models into maps of a low-poly model')
            [CompletionResult]::new('compare', 'compare', [CompletionResultType]::ParameterValue, 'Compare the tangents of two files, or of a file and a method')
            [CompletionResult]::new('inspect', 'inspect', [CompletionResultType]::ParameterValue, 'Show the contents of each primitive and the difficulties for its tangents')
            [CompletionResult]::new('render', 'render', [CompletionResultType]::ParameterValue, 'Draw a model or its tangents into a PNG')
            [CompletionResult]::new('view', 'view', [CompletionResultType]::ParameterValue, 'Show a model and its tangents in the browser')
            [CompletionResult]::new('methods', 'methods', [CompletionResultType]::ParameterValue, 'Explain the methods of computing tangents')
            [CompletionResult]::new('devices', 'devices', [CompletionResultType]::ParameterValue, 'List the adapters that can compute tangents')
            [CompletionResult]::new('completions', 'completions', [CompletionResultType]::ParameterValue, 'Print the completion script of a shell')
            break
        }
        'darboux;tangents' {
            [CompletionResult]::new('-o', '-o', [CompletionResultType]::ParameterName, 'Output file for a single input, in an existing folder; - is standard output, as GLB')
            [CompletionResult]::new('--output', '--output', [CompletionResultType]::ParameterName, 'Output file for a single input, in an existing folder; - is standard output, as GLB')
            [CompletionResult]::new('--out-dir', '--out-dir', [CompletionResultType]::ParameterName, 'Folder for all outputs, created if missing; outputs keep the names of their inputs and the structure of input folders')
            [CompletionResult]::new('--jobs', '--jobs', [CompletionResultType]::ParameterName, 'How many files are processed at the same time; by default one per processor core')
            [CompletionResult]::new('--memory-limit', '--memory-limit', [CompletionResultType]::ParameterName, 'The maximum memory for decoding a file, in MiB; by default 256 MiB plus 64 times the size of the file, and at most what the process may use')
            [CompletionResult]::new('--polygons', '--polygons', [CompletionResultType]::ParameterName, 'How faces of five and more corners are cut, in formats that have them')
            [CompletionResult]::new('--method', '--method', [CompletionResultType]::ParameterName, 'How tangents are computed: as the normal map was baked, so nearly always mikktspace')
            [CompletionResult]::new('--mode', '--mode', [CompletionResultType]::ParameterName, 'Which defects of the MikkTSpace reference implementation are kept')
            [CompletionResult]::new('--threshold', '--threshold', [CompletionResultType]::ParameterName, 'Split the tangents of faces whose directions differ by this angle or more, in degrees')
            [CompletionResult]::new('--device', '--device', [CompletionResultType]::ParameterName, 'The device that computes the tangents; all devices give the same bits')
            [CompletionResult]::new('--normals', '--normals', [CompletionResultType]::ParameterName, 'Generate missing normals first: flat, smooth or crease=DEG (smooth except at edges sharper than DEG degrees); keep generates none')
            [CompletionResult]::new('--encoding', '--encoding', [CompletionResultType]::ParameterName, 'How tangents are stored: f32x4 (16 bytes), snorm16x4 (8 bytes) or snorm8x4 (4 bytes)')
            [CompletionResult]::new('--in-place', '--in-place', [CompletionResultType]::ParameterName, 'Replace each input by its output')
            [CompletionResult]::new('--force', '--force', [CompletionResultType]::ParameterName, 'Replace output files that exist')
            [CompletionResult]::new('--resume', '--resume', [CompletionResultType]::ParameterName, 'Process only the inputs whose output in --out-dir is missing or out of date')
            [CompletionResult]::new('--retry', '--retry', [CompletionResultType]::ParameterName, 'With --resume, process also inputs that are skipped because two runs were killed while they worked on them')
            [CompletionResult]::new('-v', '-v', [CompletionResultType]::ParameterName, 'Print every primitive and warning; without it, more than 10 files get one line each')
            [CompletionResult]::new('--verbose', '--verbose', [CompletionResultType]::ParameterName, 'Print every primitive and warning; without it, more than 10 files get one line each')
            [CompletionResult]::new('--allow-outside', '--allow-outside', [CompletionResultType]::ParameterName, 'Allow a glTF''s buffers and images outside its folder')
            [CompletionResult]::new('--overwrite', '--overwrite', [CompletionResultType]::ParameterName, 'Replace existing tangents, and with --normals existing normals; without it they are kept')
            [CompletionResult]::new('--only-needed', '--only-needed', [CompletionResultType]::ParameterName, 'Process only primitives whose material uses tangents (normal map, clearcoat normal map, anisotropy)')
            [CompletionResult]::new('--apply-texture-transform', '--apply-texture-transform', [CompletionResultType]::ParameterName, 'Apply KHR_texture_transform to the UVs first')
            [CompletionResult]::new('--strict', '--strict', [CompletionResultType]::ParameterName, 'Fail for files with non-finite vertex data or with corners that have no usable tangent')
            [CompletionResult]::new('--json', '--json', [CompletionResultType]::ParameterName, 'Write a report as JSON to standard output')
            [CompletionResult]::new('-q', '-q', [CompletionResultType]::ParameterName, 'Print errors only; commands that write files also print one line with the totals')
            [CompletionResult]::new('--quiet', '--quiet', [CompletionResultType]::ParameterName, 'Print errors only; commands that write files also print one line with the totals')
            [CompletionResult]::new('-h', '-h', [CompletionResultType]::ParameterName, 'Print help (see more with ''--help'')')
            [CompletionResult]::new('--help', '--help', [CompletionResultType]::ParameterName, 'Print help (see more with ''--help'')')
            break
        }
        'darboux;normals' {
            [CompletionResult]::new('-o', '-o', [CompletionResultType]::ParameterName, 'Output file for a single input, in an existing folder; - is standard output, as GLB')
            [CompletionResult]::new('--output', '--output', [CompletionResultType]::ParameterName, 'Output file for a single input, in an existing folder; - is standard output, as GLB')
            [CompletionResult]::new('--out-dir', '--out-dir', [CompletionResultType]::ParameterName, 'Folder for all outputs, created if missing; outputs keep the names of their inputs and the structure of input folders')
            [CompletionResult]::new('--jobs', '--jobs', [CompletionResultType]::ParameterName, 'How many files are processed at the same time; by default one per processor core')
            [CompletionResult]::new('--memory-limit', '--memory-limit', [CompletionResultType]::ParameterName, 'The maximum memory for decoding a file, in MiB; by default 256 MiB plus 64 times the size of the file, and at most what the process may use')
            [CompletionResult]::new('--polygons', '--polygons', [CompletionResultType]::ParameterName, 'How faces of five and more corners are cut, in formats that have them')
            [CompletionResult]::new('--normals', '--normals', [CompletionResultType]::ParameterName, 'flat, smooth, or crease=DEG: smooth except at edges sharper than DEG degrees')
            [CompletionResult]::new('--weight', '--weight', [CompletionResultType]::ParameterName, 'The weight of each face at a smooth vertex')
            [CompletionResult]::new('--in-place', '--in-place', [CompletionResultType]::ParameterName, 'Replace each input by its output')
            [CompletionResult]::new('--force', '--force', [CompletionResultType]::ParameterName, 'Replace output files that exist')
            [CompletionResult]::new('--resume', '--resume', [CompletionResultType]::ParameterName, 'Process only the inputs whose output in --out-dir is missing or out of date')
            [CompletionResult]::new('--retry', '--retry', [CompletionResultType]::ParameterName, 'With --resume, process also inputs that are skipped because two runs were killed while they worked on them')
            [CompletionResult]::new('-v', '-v', [CompletionResultType]::ParameterName, 'Print every primitive and warning; without it, more than 10 files get one line each')
            [CompletionResult]::new('--verbose', '--verbose', [CompletionResultType]::ParameterName, 'Print every primitive and warning; without it, more than 10 files get one line each')
            [CompletionResult]::new('--allow-outside', '--allow-outside', [CompletionResultType]::ParameterName, 'Allow a glTF''s buffers and images outside its folder')
            [CompletionResult]::new('--respect-seams', '--respect-seams', [CompletionResultType]::ParameterName, 'Do not smooth across vertices with different indices, even at equal positions')
            [CompletionResult]::new('--overwrite', '--overwrite', [CompletionResultType]::ParameterName, 'Replace existing normals; without it they are kept')
            [CompletionResult]::new('--json', '--json', [CompletionResultType]::ParameterName, 'Write a report as JSON to standard output')
            [CompletionResult]::new('-q', '-q', [CompletionResultType]::ParameterName, 'Print errors only; commands that write files also print one line with the totals')
            [CompletionResult]::new('--quiet', '--quiet', [CompletionResultType]::ParameterName, 'Print errors only; commands that write files also print one line with the totals')
            [CompletionResult]::new('-h', '-h', [CompletionResultType]::ParameterName, 'Print help (see more with ''--help'')')
            [CompletionResult]::new('--help', '--help', [CompletionResultType]::ParameterName, 'Print help (see more with ''--help'')')
            break
        }
        'darboux;convert' {
            [CompletionResult]::new('--out-dir', '--out-dir', [CompletionResultType]::ParameterName, 'Folder for all outputs, created if missing; outputs keep the names of their inputs and the structure of input folders')
            [CompletionResult]::new('--jobs', '--jobs', [CompletionResultType]::ParameterName, 'How many files are processed at the same time; by default one per processor core')
            [CompletionResult]::new('--memory-limit', '--memory-limit', [CompletionResultType]::ParameterName, 'The maximum memory for decoding a file, in MiB; by default 256 MiB plus 64 times the size of the file, and at most what the process may use')
            [CompletionResult]::new('--polygons', '--polygons', [CompletionResultType]::ParameterName, 'How faces of five and more corners are cut, in formats that have them')
            [CompletionResult]::new('--from', '--from', [CompletionResultType]::ParameterName, 'The convention of the inputs; without it and --to, models are written in another format only')
            [CompletionResult]::new('--to', '--to', [CompletionResultType]::ParameterName, 'The convention of the outputs')
            [CompletionResult]::new('--layout', '--layout', [CompletionResultType]::ParameterName, 'The channels of x, y and, if stored, z of a normal map: rgb, rg, ag, la, ...')
            [CompletionResult]::new('--to-layout', '--to-layout', [CompletionResultType]::ParameterName, 'The channels in the output; by default those of --layout. A z that is not stored is computed from x and y')
            [CompletionResult]::new('--space', '--space', [CompletionResultType]::ParameterName, 'Convert normal maps to this space from the other one, with the frames of --model')
            [CompletionResult]::new('--model', '--model', [CompletionResultType]::ParameterName, 'The model that has the map (.gltf, .glb, .vrm, .obj, .ply, .stl, .fbx), with the tangents of its file, or MikkTSpace''s')
            [CompletionResult]::new('--uv-set', '--uv-set', [CompletionResultType]::ParameterName, 'The UV set n of TEXCOORD_n of the model; by default that of the material''s normal map')
            [CompletionResult]::new('-o', '-o', [CompletionResultType]::ParameterName, 'Output file for a single input, in an existing folder; - is standard output')
            [CompletionResult]::new('--output', '--output', [CompletionResultType]::ParameterName, 'Output file for a single input, in an existing folder; - is standard output')
            [CompletionResult]::new('--in-place', '--in-place', [CompletionResultType]::ParameterName, 'Replace each input by its output')
            [CompletionResult]::new('--force', '--force', [CompletionResultType]::ParameterName, 'Replace output files that exist')
            [CompletionResult]::new('--resume', '--resume', [CompletionResultType]::ParameterName, 'Process only the inputs whose output in --out-dir is missing or out of date')
            [CompletionResult]::new('--retry', '--retry', [CompletionResultType]::ParameterName, 'With --resume, process also inputs that are skipped because two runs were killed while they worked on them')
            [CompletionResult]::new('-v', '-v', [CompletionResultType]::ParameterName, 'Print every primitive and warning; without it, more than 10 files get one line each')
            [CompletionResult]::new('--verbose', '--verbose', [CompletionResultType]::ParameterName, 'Print every primitive and warning; without it, more than 10 files get one line each')
            [CompletionResult]::new('--allow-outside', '--allow-outside', [CompletionResultType]::ParameterName, 'Allow a glTF''s buffers and images outside its folder')
            [CompletionResult]::new('--raw', '--raw', [CompletionResultType]::ParameterName, 'Allow models in other conventions than glTF''s, for programs that use the numbers as they are')
            [CompletionResult]::new('--json', '--json', [CompletionResultType]::ParameterName, 'Write a report as JSON to standard output')
            [CompletionResult]::new('-q', '-q', [CompletionResultType]::ParameterName, 'Print errors only; commands that write files also print one line with the totals')
            [CompletionResult]::new('--quiet', '--quiet', [CompletionResultType]::ParameterName, 'Print errors only; commands that write files also print one line with the totals')
            [CompletionResult]::new('-h', '-h', [CompletionResultType]::ParameterName, 'Print help (see more with ''--help'')')
            [CompletionResult]::new('--help', '--help', [CompletionResultType]::ParameterName, 'Print help (see more with ''--help'')')
            break
        }
        'darboux;check' {
            [CompletionResult]::new('--jobs', '--jobs', [CompletionResultType]::ParameterName, 'How many files are processed at the same time; by default one per processor core')
            [CompletionResult]::new('--memory-limit', '--memory-limit', [CompletionResultType]::ParameterName, 'The maximum memory for decoding a file, in MiB; by default 256 MiB plus 64 times the size of the file, and at most what the process may use')
            [CompletionResult]::new('--polygons', '--polygons', [CompletionResultType]::ParameterName, 'How faces of five and more corners are cut, in formats that have them')
            [CompletionResult]::new('--explain', '--explain', [CompletionResultType]::ParameterName, 'Print the meaning of a code and exit')
            [CompletionResult]::new('--only', '--only', [CompletionResultType]::ParameterName, 'Report these codes only')
            [CompletionResult]::new('--allow', '--allow', [CompletionResultType]::ParameterName, 'Do not report these codes')
            [CompletionResult]::new('--fail-on', '--fail-on', [CompletionResultType]::ParameterName, 'The severity from which on a finding makes the exit code 1')
            [CompletionResult]::new('--convention', '--convention', [CompletionResultType]::ParameterName, 'Where the green of normal maps should point')
            [CompletionResult]::new('--assume', '--assume', [CompletionResultType]::ParameterName, 'What normal maps are where neither their texels nor the faces of the model decide it; what the texels show is not overruled')
            [CompletionResult]::new('--model', '--model', [CompletionResultType]::ParameterName, 'The model that the images are normal maps of: its faces tell inverted green from inverted red, and its tangents, normals and UVs are checked, too')
            [CompletionResult]::new('--method', '--method', [CompletionResultType]::ParameterName, 'How --fix makes tangents again: as the normal map was baked, so nearly always mikktspace')
            [CompletionResult]::new('--normals', '--normals', [CompletionResultType]::ParameterName, 'How --fix makes missing normals: flat, smooth or crease=DEG')
            [CompletionResult]::new('--report', '--report', [CompletionResultType]::ParameterName, 'Write what is found as one HTML file with pictures, which needs no network')
            [CompletionResult]::new('-o', '-o', [CompletionResultType]::ParameterName, 'Output file for a single input, in an existing folder; - is standard output, as GLB')
            [CompletionResult]::new('--output', '--output', [CompletionResultType]::ParameterName, 'Output file for a single input, in an existing folder; - is standard output, as GLB')
            [CompletionResult]::new('--out-dir', '--out-dir', [CompletionResultType]::ParameterName, 'Folder for all outputs, created if missing; outputs keep the names of their inputs and the structure of input folders')
            [CompletionResult]::new('--resume', '--resume', [CompletionResultType]::ParameterName, 'Process only the inputs whose output in --out-dir is missing or out of date')
            [CompletionResult]::new('--retry', '--retry', [CompletionResultType]::ParameterName, 'With --resume, process also inputs that are skipped because two runs were killed while they worked on them')
            [CompletionResult]::new('-v', '-v', [CompletionResultType]::ParameterName, 'Print every primitive and warning; without it, more than 10 files get one line each')
            [CompletionResult]::new('--verbose', '--verbose', [CompletionResultType]::ParameterName, 'Print every primitive and warning; without it, more than 10 files get one line each')
            [CompletionResult]::new('--allow-outside', '--allow-outside', [CompletionResultType]::ParameterName, 'Allow a glTF''s buffers and images outside its folder')
            [CompletionResult]::new('--no-maps', '--no-maps', [CompletionResultType]::ParameterName, 'Do not decode normal maps: they are taken to be right')
            [CompletionResult]::new('--fix', '--fix', [CompletionResultType]::ParameterName, 'Repair what is found, and write the result')
            [CompletionResult]::new('--dry-run', '--dry-run', [CompletionResultType]::ParameterName, 'Print the edits with which --fix would begin, and write no file')
            [CompletionResult]::new('--json', '--json', [CompletionResultType]::ParameterName, 'Write a report as JSON to standard output')
            [CompletionResult]::new('-q', '-q', [CompletionResultType]::ParameterName, 'Print errors only; commands that write files also print one line with the totals')
            [CompletionResult]::new('--quiet', '--quiet', [CompletionResultType]::ParameterName, 'Print errors only; commands that write files also print one line with the totals')
            [CompletionResult]::new('--in-place', '--in-place', [CompletionResultType]::ParameterName, 'Replace each input by its output')
            [CompletionResult]::new('--force', '--force', [CompletionResultType]::ParameterName, 'Replace output files that exist')
            [CompletionResult]::new('-h', '-h', [CompletionResultType]::ParameterName, 'Print help (see more with ''--help'')')
            [CompletionResult]::new('--help', '--help', [CompletionResultType]::ParameterName, 'Print help (see more with ''--help'')')
            break
        }
        'darboux;report' {
            [CompletionResult]::new('-o', '-o', [CompletionResultType]::ParameterName, 'The page, in an existing folder')
            [CompletionResult]::new('--output', '--output', [CompletionResultType]::ParameterName, 'The page, in an existing folder')
            [CompletionResult]::new('--pictures', '--pictures', [CompletionResultType]::ParameterName, 'How many files have pictures: the worst ones')
            [CompletionResult]::new('--only', '--only', [CompletionResultType]::ParameterName, 'Report these codes only')
            [CompletionResult]::new('--allow', '--allow', [CompletionResultType]::ParameterName, 'Do not report these codes')
            [CompletionResult]::new('--fail-on', '--fail-on', [CompletionResultType]::ParameterName, 'The severity from which on a finding makes the exit code 1')
            [CompletionResult]::new('--convention', '--convention', [CompletionResultType]::ParameterName, 'Where the green of normal maps should point')
            [CompletionResult]::new('--assume', '--assume', [CompletionResultType]::ParameterName, 'What normal maps are where neither their texels nor the faces of the model decide it; what the texels show is not overruled')
            [CompletionResult]::new('--memory-limit', '--memory-limit', [CompletionResultType]::ParameterName, 'The maximum memory for decoding a file, in MiB; by default 256 MiB plus 64 times the size of the file, and at most what the process may use')
            [CompletionResult]::new('--polygons', '--polygons', [CompletionResultType]::ParameterName, 'How faces of five and more corners are cut, in formats that have them')
            [CompletionResult]::new('--force', '--force', [CompletionResultType]::ParameterName, 'Replace the page if it exists')
            [CompletionResult]::new('--no-maps', '--no-maps', [CompletionResultType]::ParameterName, 'Do not decode normal maps: they are taken to be right')
            [CompletionResult]::new('--allow-outside', '--allow-outside', [CompletionResultType]::ParameterName, 'Allow a glTF''s buffers and images outside its folder')
            [CompletionResult]::new('-q', '-q', [CompletionResultType]::ParameterName, 'Print errors only')
            [CompletionResult]::new('--quiet', '--quiet', [CompletionResultType]::ParameterName, 'Print errors only')
            [CompletionResult]::new('-h', '-h', [CompletionResultType]::ParameterName, 'Print help (see more with ''--help'')')
            [CompletionResult]::new('--help', '--help', [CompletionResultType]::ParameterName, 'Print help (see more with ''--help'')')
            break
        }
        'darboux;bake' {
            [CompletionResult]::new('--high', '--high', [CompletionResultType]::ParameterName, 'The high models (.gltf, .glb, .vrm, .obj, .ply, .stl, .fbx), which have the detail; their materials count, with normal maps and textures')
            [CompletionResult]::new('-o', '-o', [CompletionResultType]::ParameterName, 'The map (.png, .exr, .tif), in an existing folder; with several maps the name of each is added, as in crate.ao.png, and %UDIM% becomes the number of each tile. Without it the PNG named as the model of --write-model')
            [CompletionResult]::new('--output', '--output', [CompletionResultType]::ParameterName, 'The map (.png, .exr, .tif), in an existing folder; with several maps the name of each is added, as in crate.ao.png, and %UDIM% becomes the number of each tile. Without it the PNG named as the model of --write-model')
            [CompletionResult]::new('--map', '--map', [CompletionResultType]::ParameterName, 'The maps to bake; several at once share their rays. Without it normal, or material if --write-model stands without -o')
            [CompletionResult]::new('--size', '--size', [CompletionResultType]::ParameterName, 'Texels per side, or width and height')
            [CompletionResult]::new('--bits', '--bits', [CompletionResultType]::ParameterName, 'Bits per channel: 8 or 16 (PNG), 16 or 32 (EXR, TIFF); by default the more for heights, positions and thickness, the fewer for the others')
            [CompletionResult]::new('--dither', '--dither', [CompletionResultType]::ParameterName, 'Round to 8 bits with blue noise, so that smooth surfaces show no bands; SEED moves the noise')
            [CompletionResult]::new('--pack', '--pack', [CompletionResultType]::ParameterName, 'Write an image whose channels are maps of one channel each, such as orm=ao,roughness,metalness: OUTPUT with NAME before its ending')
            [CompletionResult]::new('--samples', '--samples', [CompletionResultType]::ParameterName, 'Samples per texel: 1, 4, 9, 16 and so on up to 256')
            [CompletionResult]::new('--convention', '--convention', [CompletionResultType]::ParameterName, 'The convention of the maps: directions of red and green, axes of object-space normals and positions')
            [CompletionResult]::new('--padding', '--padding', [CompletionResultType]::ParameterName, 'Fill texels outside the charts up to this distance only, in texels; without it all are filled')
            [CompletionResult]::new('--ao-rays', '--ao-rays', [CompletionResultType]::ParameterName, 'Rays per sample of occlusion, bent normals and thickness')
            [CompletionResult]::new('--ao-distance', '--ao-distance', [CompletionResultType]::ParameterName, 'How far surfaces occlude each other, in the models'' unit; without it any distance')
            [CompletionResult]::new('--ao-falloff', '--ao-falloff', [CompletionResultType]::ParameterName, 'How occlusion fades up to --ao-distance')
            [CompletionResult]::new('--ao-weights', '--ao-weights', [CompletionResultType]::ParameterName, 'How the directions of occlusion and bent normals are weighted')
            [CompletionResult]::new('--thickness-distance', '--thickness-distance', [CompletionResultType]::ParameterName, 'How far the other side is looked for by thickness, in the models'' unit; without it at any distance')
            [CompletionResult]::new('--curvature-radius', '--curvature-radius', [CompletionResultType]::ParameterName, 'The radius in which curvature is measured: texels, as in 4texels, or a distance in the models'' unit')
            [CompletionResult]::new('--id-from', '--id-from', [CompletionResultType]::ParameterName, 'What the colours of an id map stand for')
            [CompletionResult]::new('--texture', '--texture', [CompletionResultType]::ParameterName, 'The texture of the map texture: its place in the JSON of the high models'' materials')
            [CompletionResult]::new('--world-direction', '--world-direction', [CompletionResultType]::ParameterName, 'The direction of the map world-direction, along the axes of glTF, where y is up')
            [CompletionResult]::new('--distance', '--distance', [CompletionResultType]::ParameterName, 'Rays along the interpolated normals: how far outside they begin, and how far inside they end')
            [CompletionResult]::new('--cage-offset', '--cage-offset', [CompletionResultType]::ParameterName, 'Rays from a cage: the low model, moved outwards by this distance along smooth normals, so that hard edges leave no gaps; they end as far inside')
            [CompletionResult]::new('--cage', '--cage', [CompletionResultType]::ParameterName, 'Rays from a cage that is a file: the low model with its vertices moved; they end as far inside as --cage-offset says')
            [CompletionResult]::new('--auto-cage', '--auto-cage', [CompletionResultType]::ParameterName, 'Rays from a cage that is made for the models: at every vertex as close as all but a SHARE of the rays around allows, 0.001 by default')
            [CompletionResult]::new('--skew', '--skew', [CompletionResultType]::ParameterName, 'Turn rays towards the normals of the low model''s triangles: by an AMOUNT from 0 to 1, or by a painted IMAGE over its UVs, white where rays follow the triangle''s normal and black where they follow the smooth one')
            [CompletionResult]::new('--max-misses', '--max-misses', [CompletionResultType]::ParameterName, 'Fail, and write nothing, if the rays of more than this SHARE of the texels hit nothing; without it they are a warning, unless all miss')
            [CompletionResult]::new('--write-cage', '--write-cage', [CompletionResultType]::ParameterName, 'Write the cage as a model, which --cage reads')
            [CompletionResult]::new('--match', '--match', [CompletionResultType]::ParameterName, 'Which high parts the rays of a low part can hit')
            [CompletionResult]::new('--method', '--method', [CompletionResultType]::ParameterName, 'How tangents are computed; by default those of the low model''s file are used, and mikktspace if it has none for the UV set')
            [CompletionResult]::new('--bitangent', '--bitangent', [CompletionResultType]::ParameterName, 'How the renderer rebuilds the bitangent')
            [CompletionResult]::new('--uv-set', '--uv-set', [CompletionResultType]::ParameterName, 'The UV set n of TEXCOORD_n; by default that of the material''s normal map')
            [CompletionResult]::new('--material', '--material', [CompletionResultType]::ParameterName, 'Bake only the primitives with this material, materials[N] of the low model''s file; by default all share the map')
            [CompletionResult]::new('--normals', '--normals', [CompletionResultType]::ParameterName, 'Generate missing normals of the low model first: flat, smooth or crease=DEG; keep generates none')
            [CompletionResult]::new('--write-model', '--write-model', [CompletionResultType]::ParameterName, 'Write the low model with the maps that its materials can have, and with the tangents in its vertices')
            [CompletionResult]::new('--heat-map', '--heat-map', [CompletionResultType]::ParameterName, 'Draw these errors over the UV layout, with their scale below')
            [CompletionResult]::new('--heat-model', '--heat-model', [CompletionResultType]::ParameterName, 'Write the low model painted with these errors, unlit, and beside it a PNG of their scale; `darboux render` and every viewer show it')
            [CompletionResult]::new('--heat-range', '--heat-range', [CompletionResultType]::ParameterName, 'The ends of the scale of errors in degrees; by default those that fit the errors')
            [CompletionResult]::new('--report', '--report', [CompletionResultType]::ParameterName, 'Write an HTML page with pictures of the maps, of errors and misses, and of the low model beside the high ones; it loads nothing')
            [CompletionResult]::new('--jobs', '--jobs', [CompletionResultType]::ParameterName, 'How many threads work; by default one per processor core')
            [CompletionResult]::new('--memory-limit', '--memory-limit', [CompletionResultType]::ParameterName, 'The maximum memory for decoding a file, in MiB; by default 256 MiB plus 64 times the size of the file, and at most what the process may use')
            [CompletionResult]::new('--polygons', '--polygons', [CompletionResultType]::ParameterName, 'How faces of five and more corners are cut, in formats that have them')
            [CompletionResult]::new('--ao-own-part', '--ao-own-part', [CompletionResultType]::ParameterName, 'Let parts of the high models be occluded by themselves only, not by each other')
            [CompletionResult]::new('--offset-colors', '--offset-colors', [CompletionResultType]::ParameterName, 'Multiply the distance of the cage at each vertex by the red of the low model''s vertex colours')
            [CompletionResult]::new('--back-faces', '--back-faces', [CompletionResultType]::ParameterName, 'Let rays hit triangles from behind')
            [CompletionResult]::new('--no-high-maps', '--no-high-maps', [CompletionResultType]::ParameterName, 'Bake the geometry of the high models without the normal maps of their materials')
            [CompletionResult]::new('--verify', '--verify', [CompletionResultType]::ParameterName, 'Shade the low model with the map that was written, as a renderer does, and print how far its normals are from those of the high models')
            [CompletionResult]::new('--suffixes', '--suffixes', [CompletionResultType]::ParameterName, 'Bake each NAME_low in the folder LOW from NAME_high, with the cage NAME_cage if there is one, into NAME.png in the folder of -o, or in LOW')
            [CompletionResult]::new('--resume', '--resume', [CompletionResultType]::ParameterName, 'Skip bakes of a job whose models, options and outputs have not changed since an earlier run; a killed run is continued')
            [CompletionResult]::new('--retry', '--retry', [CompletionResultType]::ParameterName, 'With --resume, bake also pairs that are skipped because two runs were killed while they worked on them')
            [CompletionResult]::new('--force', '--force', [CompletionResultType]::ParameterName, 'Replace files that exist')
            [CompletionResult]::new('--allow-outside', '--allow-outside', [CompletionResultType]::ParameterName, 'Allow a glTF''s buffers and images outside its folder')
            [CompletionResult]::new('--json', '--json', [CompletionResultType]::ParameterName, 'Write a report as JSON to standard output')
            [CompletionResult]::new('-q', '-q', [CompletionResultType]::ParameterName, 'Print errors only; commands that write files also print one line with the totals')
            [CompletionResult]::new('--quiet', '--quiet', [CompletionResultType]::ParameterName, 'Print errors only; commands that write files also print one line with the totals')
            [CompletionResult]::new('-h', '-h', [CompletionResultType]::ParameterName, 'Print help (see more with ''--help'')')
            [CompletionResult]::new('--help', '--help', [CompletionResultType]::ParameterName, 'Print help (see more with ''--help'')')
            break
        }
        'darboux;compare' {
            [CompletionResult]::new('--method', '--method', [CompletionResultType]::ParameterName, 'Compare A with the tangents that this method computes for A; `darboux methods` lists the methods')
            [CompletionResult]::new('--worst', '--worst', [CompletionResultType]::ParameterName, 'How many of the worst corners are listed')
            [CompletionResult]::new('--tolerance', '--tolerance', [CompletionResultType]::ParameterName, 'Exit with 3 if an angle is larger than this, a sign w is opposite, or one side lacks tangents')
            [CompletionResult]::new('--heat-map', '--heat-map', [CompletionResultType]::ParameterName, 'Draw the angles over the UV layout, as a PNG')
            [CompletionResult]::new('--memory-limit', '--memory-limit', [CompletionResultType]::ParameterName, 'The maximum memory for decoding a file, in MiB; by default 256 MiB plus 64 times the size of the file, and at most what the process may use')
            [CompletionResult]::new('--polygons', '--polygons', [CompletionResultType]::ParameterName, 'How faces of five and more corners are cut, in formats that have them')
            [CompletionResult]::new('--force', '--force', [CompletionResultType]::ParameterName, 'Replace a heat map that exists')
            [CompletionResult]::new('--allow-outside', '--allow-outside', [CompletionResultType]::ParameterName, 'Allow a glTF''s buffers and images outside its folder')
            [CompletionResult]::new('--json', '--json', [CompletionResultType]::ParameterName, 'Write a report as JSON to standard output')
            [CompletionResult]::new('-q', '-q', [CompletionResultType]::ParameterName, 'Print errors only; commands that write files also print one line with the totals')
            [CompletionResult]::new('--quiet', '--quiet', [CompletionResultType]::ParameterName, 'Print errors only; commands that write files also print one line with the totals')
            [CompletionResult]::new('-h', '-h', [CompletionResultType]::ParameterName, 'Print help (see more with ''--help'')')
            [CompletionResult]::new('--help', '--help', [CompletionResultType]::ParameterName, 'Print help (see more with ''--help'')')
            break
        }
        'darboux;inspect' {
            [CompletionResult]::new('--memory-limit', '--memory-limit', [CompletionResultType]::ParameterName, 'The maximum memory for decoding a file, in MiB; by default 256 MiB plus 64 times the size of the file, and at most what the process may use')
            [CompletionResult]::new('--polygons', '--polygons', [CompletionResultType]::ParameterName, 'How faces of five and more corners are cut, in formats that have them')
            [CompletionResult]::new('--allow-outside', '--allow-outside', [CompletionResultType]::ParameterName, 'Allow a glTF''s buffers and images outside its folder')
            [CompletionResult]::new('--json', '--json', [CompletionResultType]::ParameterName, 'Write a report as JSON to standard output')
            [CompletionResult]::new('-q', '-q', [CompletionResultType]::ParameterName, 'Print errors only; commands that write files also print one line with the totals')
            [CompletionResult]::new('--quiet', '--quiet', [CompletionResultType]::ParameterName, 'Print errors only; commands that write files also print one line with the totals')
            [CompletionResult]::new('-h', '-h', [CompletionResultType]::ParameterName, 'Print help (see more with ''--help'')')
            [CompletionResult]::new('--help', '--help', [CompletionResultType]::ParameterName, 'Print help (see more with ''--help'')')
            break
        }
        'darboux;render' {
            [CompletionResult]::new('-o', '-o', [CompletionResultType]::ParameterName, 'The picture, in an existing folder')
            [CompletionResult]::new('--output', '--output', [CompletionResultType]::ParameterName, 'The picture, in an existing folder')
            [CompletionResult]::new('--view', '--view', [CompletionResultType]::ParameterName, 'What the colours of the surface show')
            [CompletionResult]::new('--tangents', '--tangents', [CompletionResultType]::ParameterName, 'The source of the tangents: file, derivatives (as shaders without tangents derive them), or a method; `darboux methods` lists the methods')
            [CompletionResult]::new('--against', '--against', [CompletionResultType]::ParameterName, 'The second source of tangents, for --view angle and for the right side of --split')
            [CompletionResult]::new('--split', '--split', [CompletionResultType]::ParameterName, 'Divide the picture at this percentage of its width: --tangents on the left; --against, or --mistakes, on the right')
            [CompletionResult]::new('--lines', '--lines', [CompletionResultType]::ParameterName, 'Draw these vectors at the vertices')
            [CompletionResult]::new('--length', '--length', [CompletionResultType]::ParameterName, 'The length of the lines, in percent of the model''s radius')
            [CompletionResult]::new('--layout', '--layout', [CompletionResultType]::ParameterName, 'Draw the UV layout in the colours of the surface (in those of the sign for the shaded view), v down')
            [CompletionResult]::new('--mistakes', '--mistakes', [CompletionResultType]::ParameterName, 'Make these mistakes, on the right of --split or in the whole picture')
            [CompletionResult]::new('--mesh', '--mesh', [CompletionResultType]::ParameterName, 'Draw only this mesh, given by its name or index; can be repeated')
            [CompletionResult]::new('--size', '--size', [CompletionResultType]::ParameterName, 'Width and height in pixels, at least 1x1')
            [CompletionResult]::new('--camera', '--camera', [CompletionResultType]::ParameterName, 'Degrees around the model (0 is its front), degrees above the horizon, and the magnification (1 shows the whole model)')
            [CompletionResult]::new('--look', '--look', [CompletionResultType]::ParameterName, 'Where the camera is and what it looks at, as `view=` in a link of the viewer has it; the light comes from where the viewer has it')
            [CompletionResult]::new('--background', '--background', [CompletionResultType]::ParameterName, 'The colour behind the model')
            [CompletionResult]::new('--memory-limit', '--memory-limit', [CompletionResultType]::ParameterName, 'The maximum memory for decoding a file, in MiB; by default 256 MiB plus 64 times the size of the file, and at most what the process may use')
            [CompletionResult]::new('--polygons', '--polygons', [CompletionResultType]::ParameterName, 'How faces of five and more corners are cut, in formats that have them')
            [CompletionResult]::new('--seams', '--seams', [CompletionResultType]::ParameterName, 'Draw mirrored seams: the edges across which the sign w changes')
            [CompletionResult]::new('--ground', '--ground', [CompletionResultType]::ParameterName, 'Stand the lit model on a ground that shows its shadow, as the viewer does')
            [CompletionResult]::new('--no-legend', '--no-legend', [CompletionResultType]::ParameterName, 'Draw no legend and no names of the two sides')
            [CompletionResult]::new('--force', '--force', [CompletionResultType]::ParameterName, 'Replace a picture that exists')
            [CompletionResult]::new('--allow-outside', '--allow-outside', [CompletionResultType]::ParameterName, 'Allow a glTF''s buffers and images outside its folder')
            [CompletionResult]::new('--json', '--json', [CompletionResultType]::ParameterName, 'Write a report as JSON to standard output')
            [CompletionResult]::new('-q', '-q', [CompletionResultType]::ParameterName, 'Print errors only; commands that write files also print one line with the totals')
            [CompletionResult]::new('--quiet', '--quiet', [CompletionResultType]::ParameterName, 'Print errors only; commands that write files also print one line with the totals')
            [CompletionResult]::new('-h', '-h', [CompletionResultType]::ParameterName, 'Print help (see more with ''--help'')')
            [CompletionResult]::new('--help', '--help', [CompletionResultType]::ParameterName, 'Print help (see more with ''--help'')')
            break
        }
        'darboux;view' {
            [CompletionResult]::new('--high', '--high', [CompletionResultType]::ParameterName, 'A high-poly model whose detail the page bakes into a normal map of MODEL')
            [CompletionResult]::new('--memory-limit', '--memory-limit', [CompletionResultType]::ParameterName, 'The maximum memory for decoding a file, in MiB; by default 256 MiB plus 64 times the size of the file, and at most what the process may use')
            [CompletionResult]::new('--polygons', '--polygons', [CompletionResultType]::ParameterName, 'How faces of five and more corners are cut, in formats that have them')
            [CompletionResult]::new('--page', '--page', [CompletionResultType]::ParameterName, 'The folder with the page''s files')
            [CompletionResult]::new('--no-open', '--no-open', [CompletionResultType]::ParameterName, 'Print the address and open no browser')
            [CompletionResult]::new('--allow-outside', '--allow-outside', [CompletionResultType]::ParameterName, 'Allow a glTF''s buffers and images outside its folder')
            [CompletionResult]::new('-h', '-h', [CompletionResultType]::ParameterName, 'Print help (see more with ''--help'')')
            [CompletionResult]::new('--help', '--help', [CompletionResultType]::ParameterName, 'Print help (see more with ''--help'')')
            break
        }
        'darboux;methods' {
            [CompletionResult]::new('-h', '-h', [CompletionResultType]::ParameterName, 'Print help')
            [CompletionResult]::new('--help', '--help', [CompletionResultType]::ParameterName, 'Print help')
            break
        }
        'darboux;devices' {
            [CompletionResult]::new('--json', '--json', [CompletionResultType]::ParameterName, 'Print a JSON report to standard output')
            [CompletionResult]::new('-h', '-h', [CompletionResultType]::ParameterName, 'Print help (see more with ''--help'')')
            [CompletionResult]::new('--help', '--help', [CompletionResultType]::ParameterName, 'Print help (see more with ''--help'')')
            break
        }
        'darboux;completions' {
            [CompletionResult]::new('-h', '-h', [CompletionResultType]::ParameterName, 'Print help (see more with ''--help'')')
            [CompletionResult]::new('--help', '--help', [CompletionResultType]::ParameterName, 'Print help (see more with ''--help'')')
            break
        }
    })

    $completions.Where{ $_.CompletionText -like "$wordToComplete*" } |
        Sort-Object -Property ListItemText
}
