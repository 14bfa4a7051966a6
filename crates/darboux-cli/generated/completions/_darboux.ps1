
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
            [CompletionResult]::new('tangents', 'tangents', [CompletionResultType]::ParameterValue, 'Add tangents to glTF and GLB files')
            [CompletionResult]::new('normals', 'normals', [CompletionResultType]::ParameterValue, 'Add normals to glTF and GLB files')
            [CompletionResult]::new('convert', 'convert', [CompletionResultType]::ParameterValue, 'Convert normal maps and models between conventions')
            [CompletionResult]::new('compare', 'compare', [CompletionResultType]::ParameterValue, 'Compare the tangents of two files, or of a file and a method')
            [CompletionResult]::new('inspect', 'inspect', [CompletionResultType]::ParameterValue, 'Show what each primitive holds and what its tangents would meet')
            [CompletionResult]::new('render', 'render', [CompletionResultType]::ParameterValue, 'Draw a model or its tangents into a PNG')
            [CompletionResult]::new('view', 'view', [CompletionResultType]::ParameterValue, 'Show a model in the browser, with its tangents')
            [CompletionResult]::new('methods', 'methods', [CompletionResultType]::ParameterValue, 'Say which method of computing tangents is for what')
            [CompletionResult]::new('devices', 'devices', [CompletionResultType]::ParameterValue, 'List the adapters that can compute tangents')
            break
        }
        'darboux;tangents' {
            [CompletionResult]::new('-o', '-o', [CompletionResultType]::ParameterName, 'Output file for a single input, in a folder that exists; - is standard output, as GLB')
            [CompletionResult]::new('--output', '--output', [CompletionResultType]::ParameterName, 'Output file for a single input, in a folder that exists; - is standard output, as GLB')
            [CompletionResult]::new('--out-dir', '--out-dir', [CompletionResultType]::ParameterName, 'Folder for all outputs, made if missing; they have the names of their inputs, and an input folder''s structure is kept')
            [CompletionResult]::new('--jobs', '--jobs', [CompletionResultType]::ParameterName, 'How many files are worked on at the same time')
            [CompletionResult]::new('--memory-limit', '--memory-limit', [CompletionResultType]::ParameterName, 'The most memory that a file may ask for; without it, 256 MiB and 64 times the size of the file')
            [CompletionResult]::new('--method', '--method', [CompletionResultType]::ParameterName, 'How tangents are computed: as the normal map was baked, so nearly always mikktspace')
            [CompletionResult]::new('--mode', '--mode', [CompletionResultType]::ParameterName, 'Which defects of the MikkTSpace reference to keep')
            [CompletionResult]::new('--threshold', '--threshold', [CompletionResultType]::ParameterName, 'Split tangents of faces whose directions differ by this many degrees or more')
            [CompletionResult]::new('--device', '--device', [CompletionResultType]::ParameterName, 'What computes the tangents: the bits are the same')
            [CompletionResult]::new('--normals', '--normals', [CompletionResultType]::ParameterName, 'keep normals as they are, or first make those that are missing: flat, smooth or crease=DEG')
            [CompletionResult]::new('--encoding', '--encoding', [CompletionResultType]::ParameterName, 'How tangents are stored: f32x4 (16 bytes), snorm16x4 (8) or snorm8x4 (4)')
            [CompletionResult]::new('--in-place', '--in-place', [CompletionResultType]::ParameterName, 'Replace each input by its output')
            [CompletionResult]::new('--force', '--force', [CompletionResultType]::ParameterName, 'Replace output files that exist')
            [CompletionResult]::new('--resume', '--resume', [CompletionResultType]::ParameterName, 'Leave out inputs whose output in --out-dir is up to date, and replace those that are not')
            [CompletionResult]::new('--allow-outside', '--allow-outside', [CompletionResultType]::ParameterName, 'Allow a glTF''s buffers and images outside its folder')
            [CompletionResult]::new('--overwrite', '--overwrite', [CompletionResultType]::ParameterName, 'Replace tangents that exist, and with --normals normals; without it such primitives are kept')
            [CompletionResult]::new('--only-needed', '--only-needed', [CompletionResultType]::ParameterName, 'Only primitives whose material uses tangents (normal map, clearcoat normal map, anisotropy)')
            [CompletionResult]::new('--apply-texture-transform', '--apply-texture-transform', [CompletionResultType]::ParameterName, 'Apply KHR_texture_transform to the UVs first')
            [CompletionResult]::new('--strict', '--strict', [CompletionResultType]::ParameterName, 'Refuse files with non-finite vertex data or corners that have no usable tangent')
            [CompletionResult]::new('--json', '--json', [CompletionResultType]::ParameterName, 'Write a report as JSON to standard output')
            [CompletionResult]::new('-q', '-q', [CompletionResultType]::ParameterName, 'Print errors only')
            [CompletionResult]::new('--quiet', '--quiet', [CompletionResultType]::ParameterName, 'Print errors only')
            [CompletionResult]::new('-h', '-h', [CompletionResultType]::ParameterName, 'Print help (see more with ''--help'')')
            [CompletionResult]::new('--help', '--help', [CompletionResultType]::ParameterName, 'Print help (see more with ''--help'')')
            break
        }
        'darboux;normals' {
            [CompletionResult]::new('-o', '-o', [CompletionResultType]::ParameterName, 'Output file for a single input, in a folder that exists; - is standard output, as GLB')
            [CompletionResult]::new('--output', '--output', [CompletionResultType]::ParameterName, 'Output file for a single input, in a folder that exists; - is standard output, as GLB')
            [CompletionResult]::new('--out-dir', '--out-dir', [CompletionResultType]::ParameterName, 'Folder for all outputs, made if missing; they have the names of their inputs, and an input folder''s structure is kept')
            [CompletionResult]::new('--jobs', '--jobs', [CompletionResultType]::ParameterName, 'How many files are worked on at the same time')
            [CompletionResult]::new('--memory-limit', '--memory-limit', [CompletionResultType]::ParameterName, 'The most memory that a file may ask for; without it, 256 MiB and 64 times the size of the file')
            [CompletionResult]::new('--normals', '--normals', [CompletionResultType]::ParameterName, 'flat, smooth, or crease=DEG: smooth but for edges that are sharper than so many degrees')
            [CompletionResult]::new('--weight', '--weight', [CompletionResultType]::ParameterName, 'How much each face counts at a vertex of a smooth surface')
            [CompletionResult]::new('--in-place', '--in-place', [CompletionResultType]::ParameterName, 'Replace each input by its output')
            [CompletionResult]::new('--force', '--force', [CompletionResultType]::ParameterName, 'Replace output files that exist')
            [CompletionResult]::new('--resume', '--resume', [CompletionResultType]::ParameterName, 'Leave out inputs whose output in --out-dir is up to date, and replace those that are not')
            [CompletionResult]::new('--allow-outside', '--allow-outside', [CompletionResultType]::ParameterName, 'Allow a glTF''s buffers and images outside its folder')
            [CompletionResult]::new('--respect-seams', '--respect-seams', [CompletionResultType]::ParameterName, 'Vertices stay apart where the index list has them apart, at equal positions too')
            [CompletionResult]::new('--overwrite', '--overwrite', [CompletionResultType]::ParameterName, 'Replace normals that exist; without it such primitives are kept')
            [CompletionResult]::new('--json', '--json', [CompletionResultType]::ParameterName, 'Write a report as JSON to standard output')
            [CompletionResult]::new('-q', '-q', [CompletionResultType]::ParameterName, 'Print errors only')
            [CompletionResult]::new('--quiet', '--quiet', [CompletionResultType]::ParameterName, 'Print errors only')
            [CompletionResult]::new('-h', '-h', [CompletionResultType]::ParameterName, 'Print help (see more with ''--help'')')
            [CompletionResult]::new('--help', '--help', [CompletionResultType]::ParameterName, 'Print help (see more with ''--help'')')
            break
        }
        'darboux;convert' {
            [CompletionResult]::new('--out-dir', '--out-dir', [CompletionResultType]::ParameterName, 'Folder for all outputs, made if missing; they have the names of their inputs, and an input folder''s structure is kept')
            [CompletionResult]::new('--jobs', '--jobs', [CompletionResultType]::ParameterName, 'How many files are worked on at the same time')
            [CompletionResult]::new('--memory-limit', '--memory-limit', [CompletionResultType]::ParameterName, 'The most memory that a file may ask for; without it, 256 MiB and 64 times the size of the file')
            [CompletionResult]::new('--from', '--from', [CompletionResultType]::ParameterName, 'The convention that the files are in')
            [CompletionResult]::new('--to', '--to', [CompletionResultType]::ParameterName, 'The convention that they shall be in')
            [CompletionResult]::new('--layout', '--layout', [CompletionResultType]::ParameterName, 'Channels of a normal map''s x, y and, where it is stored, z, in this order: rgb, rg, ag, la, ...')
            [CompletionResult]::new('--to-layout', '--to-layout', [CompletionResultType]::ParameterName, 'Channels that they shall be in; the same unless given. A z that was not stored is rebuilt')
            [CompletionResult]::new('-o', '-o', [CompletionResultType]::ParameterName, 'Output file for a single input, in a folder that exists; - is standard output')
            [CompletionResult]::new('--output', '--output', [CompletionResultType]::ParameterName, 'Output file for a single input, in a folder that exists; - is standard output')
            [CompletionResult]::new('--in-place', '--in-place', [CompletionResultType]::ParameterName, 'Replace each input by its output')
            [CompletionResult]::new('--force', '--force', [CompletionResultType]::ParameterName, 'Replace output files that exist')
            [CompletionResult]::new('--resume', '--resume', [CompletionResultType]::ParameterName, 'Leave out inputs whose output in --out-dir is up to date, and replace those that are not')
            [CompletionResult]::new('--allow-outside', '--allow-outside', [CompletionResultType]::ParameterName, 'Allow a glTF''s buffers and images outside its folder')
            [CompletionResult]::new('--raw', '--raw', [CompletionResultType]::ParameterName, 'Let a model leave glTF''s convention: for programs that copy its numbers as they are')
            [CompletionResult]::new('--json', '--json', [CompletionResultType]::ParameterName, 'Write a report as JSON to standard output')
            [CompletionResult]::new('-q', '-q', [CompletionResultType]::ParameterName, 'Print errors only')
            [CompletionResult]::new('--quiet', '--quiet', [CompletionResultType]::ParameterName, 'Print errors only')
            [CompletionResult]::new('-h', '-h', [CompletionResultType]::ParameterName, 'Print help (see more with ''--help'')')
            [CompletionResult]::new('--help', '--help', [CompletionResultType]::ParameterName, 'Print help (see more with ''--help'')')
            break
        }
        'darboux;compare' {
            [CompletionResult]::new('--method', '--method', [CompletionResultType]::ParameterName, 'Compare A with the tangents that this method gives it; `darboux methods` lists them')
            [CompletionResult]::new('--worst', '--worst', [CompletionResultType]::ParameterName, 'How many of the worst places are listed')
            [CompletionResult]::new('--tolerance', '--tolerance', [CompletionResultType]::ParameterName, 'Exit with 3 if an angle is greater than so many degrees, a sign is flipped, or tangents are missing on one side')
            [CompletionResult]::new('--heat-map', '--heat-map', [CompletionResultType]::ParameterName, 'Draw the angles over the UV layout, as a PNG')
            [CompletionResult]::new('--memory-limit', '--memory-limit', [CompletionResultType]::ParameterName, 'The most memory that a file may ask for; without it, 256 MiB and 64 times the size of the file')
            [CompletionResult]::new('--force', '--force', [CompletionResultType]::ParameterName, 'Replace a heat map that exists')
            [CompletionResult]::new('--allow-outside', '--allow-outside', [CompletionResultType]::ParameterName, 'Allow a glTF''s buffers and images outside its folder')
            [CompletionResult]::new('--json', '--json', [CompletionResultType]::ParameterName, 'Write a report as JSON to standard output')
            [CompletionResult]::new('-q', '-q', [CompletionResultType]::ParameterName, 'Print errors only')
            [CompletionResult]::new('--quiet', '--quiet', [CompletionResultType]::ParameterName, 'Print errors only')
            [CompletionResult]::new('-h', '-h', [CompletionResultType]::ParameterName, 'Print help (see more with ''--help'')')
            [CompletionResult]::new('--help', '--help', [CompletionResultType]::ParameterName, 'Print help (see more with ''--help'')')
            break
        }
        'darboux;inspect' {
            [CompletionResult]::new('--memory-limit', '--memory-limit', [CompletionResultType]::ParameterName, 'The most memory that a file may ask for; without it, 256 MiB and 64 times the size of the file')
            [CompletionResult]::new('--allow-outside', '--allow-outside', [CompletionResultType]::ParameterName, 'Allow a glTF''s buffers and images outside its folder')
            [CompletionResult]::new('--json', '--json', [CompletionResultType]::ParameterName, 'Write a report as JSON to standard output')
            [CompletionResult]::new('-q', '-q', [CompletionResultType]::ParameterName, 'Print errors only')
            [CompletionResult]::new('--quiet', '--quiet', [CompletionResultType]::ParameterName, 'Print errors only')
            [CompletionResult]::new('-h', '-h', [CompletionResultType]::ParameterName, 'Print help (see more with ''--help'')')
            [CompletionResult]::new('--help', '--help', [CompletionResultType]::ParameterName, 'Print help (see more with ''--help'')')
            break
        }
        'darboux;render' {
            [CompletionResult]::new('-o', '-o', [CompletionResultType]::ParameterName, 'The picture')
            [CompletionResult]::new('--output', '--output', [CompletionResultType]::ParameterName, 'The picture')
            [CompletionResult]::new('--view', '--view', [CompletionResultType]::ParameterName, 'What the surface is painted with')
            [CompletionResult]::new('--tangents', '--tangents', [CompletionResultType]::ParameterName, 'Whose tangents: file, derivatives (what shaders do that have none), or a method, as `darboux methods` lists them')
            [CompletionResult]::new('--against', '--against', [CompletionResultType]::ParameterName, 'The other tangents: what --view angle compares with, and what --split shows on the right')
            [CompletionResult]::new('--split', '--split', [CompletionResultType]::ParameterName, 'Show --tangents left of so many percent of the width, and --against right of them; or the same there, with --mistakes')
            [CompletionResult]::new('--lines', '--lines', [CompletionResultType]::ParameterName, 'Draw these vectors at the vertices')
            [CompletionResult]::new('--length', '--length', [CompletionResultType]::ParameterName, 'Length of lines, in percent of the model''s radius')
            [CompletionResult]::new('--layout', '--layout', [CompletionResultType]::ParameterName, 'Draw the UV layout in the surface''s colours (signs where it is shaded), v down')
            [CompletionResult]::new('--mistakes', '--mistakes', [CompletionResultType]::ParameterName, 'Do this wrong; right of --split, or everywhere')
            [CompletionResult]::new('--mesh', '--mesh', [CompletionResultType]::ParameterName, 'Draw this mesh alone: its name, or else its index; several times for several')
            [CompletionResult]::new('--size', '--size', [CompletionResultType]::ParameterName, 'Pixels across and down')
            [CompletionResult]::new('--camera', '--camera', [CompletionResultType]::ParameterName, 'Degrees around the model (0 is its front), degrees above the horizon, and how many times nearer than all of it in view')
            [CompletionResult]::new('--background', '--background', [CompletionResultType]::ParameterName, 'The colour behind the model')
            [CompletionResult]::new('--memory-limit', '--memory-limit', [CompletionResultType]::ParameterName, 'The most memory that a file may ask for; without it, 256 MiB and 64 times the size of the file')
            [CompletionResult]::new('--seams', '--seams', [CompletionResultType]::ParameterName, 'Draw the edges across which the sign changes: where a texture meets its mirror image')
            [CompletionResult]::new('--no-legend', '--no-legend', [CompletionResultType]::ParameterName, 'Leave out what explains the colours, and the names of both sides')
            [CompletionResult]::new('--force', '--force', [CompletionResultType]::ParameterName, 'Replace a picture that exists')
            [CompletionResult]::new('--allow-outside', '--allow-outside', [CompletionResultType]::ParameterName, 'Allow a glTF''s buffers and images outside its folder')
            [CompletionResult]::new('--json', '--json', [CompletionResultType]::ParameterName, 'Write a report as JSON to standard output')
            [CompletionResult]::new('-q', '-q', [CompletionResultType]::ParameterName, 'Print errors only')
            [CompletionResult]::new('--quiet', '--quiet', [CompletionResultType]::ParameterName, 'Print errors only')
            [CompletionResult]::new('-h', '-h', [CompletionResultType]::ParameterName, 'Print help (see more with ''--help'')')
            [CompletionResult]::new('--help', '--help', [CompletionResultType]::ParameterName, 'Print help (see more with ''--help'')')
            break
        }
        'darboux;view' {
            [CompletionResult]::new('--memory-limit', '--memory-limit', [CompletionResultType]::ParameterName, 'The most memory that a file may ask for; without it, 256 MiB and 64 times the size of the file')
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
    })

    $completions.Where{ $_.CompletionText -like "$wordToComplete*" } |
        Sort-Object -Property ListItemText
}
