_darboux() {
    local i cur prev opts cmd
    COMPREPLY=()
    if [[ "${BASH_VERSINFO[0]}" -ge 4 ]]; then
        cur="$2"
    else
        cur="${COMP_WORDS[COMP_CWORD]}"
    fi
    prev="$3"
    cmd=""
    opts=""

    for i in "${COMP_WORDS[@]:0:COMP_CWORD}"
    do
        case "${cmd},${i}" in
            ",$1")
                cmd="darboux"
                ;;
            darboux,bake)
                cmd="darboux__subcmd__bake"
                ;;
            darboux,check)
                cmd="darboux__subcmd__check"
                ;;
            darboux,compare)
                cmd="darboux__subcmd__compare"
                ;;
            darboux,completions)
                cmd="darboux__subcmd__completions"
                ;;
            darboux,convert)
                cmd="darboux__subcmd__convert"
                ;;
            darboux,devices)
                cmd="darboux__subcmd__devices"
                ;;
            darboux,inspect)
                cmd="darboux__subcmd__inspect"
                ;;
            darboux,methods)
                cmd="darboux__subcmd__methods"
                ;;
            darboux,normals)
                cmd="darboux__subcmd__normals"
                ;;
            darboux,render)
                cmd="darboux__subcmd__render"
                ;;
            darboux,report)
                cmd="darboux__subcmd__report"
                ;;
            darboux,tangents)
                cmd="darboux__subcmd__tangents"
                ;;
            darboux,view)
                cmd="darboux__subcmd__view"
                ;;
            *)
                ;;
        esac
    done

    case "${cmd}" in
        darboux)
            opts="-h -V --help --version tangents normals convert check report bake compare inspect render view methods devices completions"
            if [[ ${cur} == -* || ${COMP_CWORD} -eq 1 ]] ; then
                COMPREPLY=( $(compgen -W "${opts}" -- "${cur}") )
                return 0
            fi
            case "${prev}" in
                *)
                    COMPREPLY=()
                    ;;
            esac
            COMPREPLY=( $(compgen -W "${opts}" -- "${cur}") )
            return 0
            ;;
        darboux__subcmd__bake)
            opts="-o -q -h --high --output --map --size --bits --dither --pack --samples --convention --padding --ao-rays --ao-distance --ao-falloff --ao-weights --ao-own-part --thickness-distance --curvature-radius --id-from --texture --world-direction --distance --cage-offset --cage --auto-cage --offset-colors --skew --max-misses --write-cage --match --back-faces --no-high-maps --method --bitangent --uv-set --material --normals --write-model --verify --heat-map --heat-model --heat-range --report --suffixes --resume --retry --jobs --force --allow-outside --memory-limit --polygons --json --quiet --help"
            if [[ ${cur} == -* || ${COMP_CWORD} -eq 2 ]] ; then
                COMPREPLY=( $(compgen -W "${opts}" -- "${cur}") )
                return 0
            fi
            case "${prev}" in
                --high)
                    COMPREPLY=($(compgen -f "${cur}"))
                    return 0
                    ;;
                --output)
                    COMPREPLY=($(compgen -f "${cur}"))
                    return 0
                    ;;
                -o)
                    COMPREPLY=($(compgen -f "${cur}"))
                    return 0
                    ;;
                --map)
                    COMPREPLY=($(compgen -W "normal object-normal height ao position bent-normal object-bent-normal thickness curvature id vertex-color base-color opacity roughness metalness emission texture world-direction uv-islands wireframe material" -- "${cur}"))
                    return 0
                    ;;
                --size)
                    COMPREPLY=($(compgen -f "${cur}"))
                    return 0
                    ;;
                --bits)
                    COMPREPLY=($(compgen -f "${cur}"))
                    return 0
                    ;;
                --dither)
                    COMPREPLY=($(compgen -f "${cur}"))
                    return 0
                    ;;
                --pack)
                    COMPREPLY=($(compgen -f "${cur}"))
                    return 0
                    ;;
                --samples)
                    COMPREPLY=($(compgen -f "${cur}"))
                    return 0
                    ;;
                --convention)
                    COMPREPLY=($(compgen -W "gltf opengl directx blender unity unreal godot threejs maya 3dsmax" -- "${cur}"))
                    return 0
                    ;;
                --padding)
                    COMPREPLY=($(compgen -f "${cur}"))
                    return 0
                    ;;
                --ao-rays)
                    COMPREPLY=($(compgen -f "${cur}"))
                    return 0
                    ;;
                --ao-distance)
                    COMPREPLY=($(compgen -f "${cur}"))
                    return 0
                    ;;
                --ao-falloff)
                    COMPREPLY=($(compgen -W "none linear quadratic" -- "${cur}"))
                    return 0
                    ;;
                --ao-weights)
                    COMPREPLY=($(compgen -W "cosine uniform" -- "${cur}"))
                    return 0
                    ;;
                --thickness-distance)
                    COMPREPLY=($(compgen -f "${cur}"))
                    return 0
                    ;;
                --curvature-radius)
                    COMPREPLY=($(compgen -f "${cur}"))
                    return 0
                    ;;
                --id-from)
                    COMPREPLY=($(compgen -W "material mesh part vertex-color" -- "${cur}"))
                    return 0
                    ;;
                --texture)
                    COMPREPLY=($(compgen -f "${cur}"))
                    return 0
                    ;;
                --world-direction)
                    COMPREPLY=($(compgen -f "${cur}"))
                    return 0
                    ;;
                --distance)
                    COMPREPLY=($(compgen -f "${cur}"))
                    return 0
                    ;;
                --cage-offset)
                    COMPREPLY=($(compgen -f "${cur}"))
                    return 0
                    ;;
                --cage)
                    COMPREPLY=($(compgen -f "${cur}"))
                    return 0
                    ;;
                --auto-cage)
                    COMPREPLY=($(compgen -f "${cur}"))
                    return 0
                    ;;
                --skew)
                    COMPREPLY=($(compgen -f "${cur}"))
                    return 0
                    ;;
                --max-misses)
                    COMPREPLY=($(compgen -f "${cur}"))
                    return 0
                    ;;
                --write-cage)
                    COMPREPLY=($(compgen -f "${cur}"))
                    return 0
                    ;;
                --match)
                    COMPREPLY=($(compgen -W "nearest name" -- "${cur}"))
                    return 0
                    ;;
                --method)
                    COMPREPLY=($(compgen -W "mikktspace angle-area lengyel lengyel-per-vertex average area face from-normal angle-edge" -- "${cur}"))
                    return 0
                    ;;
                --bitangent)
                    COMPREPLY=($(compgen -W "pixel vertex" -- "${cur}"))
                    return 0
                    ;;
                --uv-set)
                    COMPREPLY=($(compgen -f "${cur}"))
                    return 0
                    ;;
                --material)
                    COMPREPLY=($(compgen -f "${cur}"))
                    return 0
                    ;;
                --normals)
                    COMPREPLY=($(compgen -f "${cur}"))
                    return 0
                    ;;
                --write-model)
                    COMPREPLY=($(compgen -f "${cur}"))
                    return 0
                    ;;
                --heat-map)
                    COMPREPLY=($(compgen -f "${cur}"))
                    return 0
                    ;;
                --heat-model)
                    COMPREPLY=($(compgen -f "${cur}"))
                    return 0
                    ;;
                --heat-range)
                    COMPREPLY=($(compgen -f "${cur}"))
                    return 0
                    ;;
                --report)
                    COMPREPLY=($(compgen -f "${cur}"))
                    return 0
                    ;;
                --jobs)
                    COMPREPLY=($(compgen -f "${cur}"))
                    return 0
                    ;;
                --memory-limit)
                    COMPREPLY=($(compgen -f "${cur}"))
                    return 0
                    ;;
                --polygons)
                    COMPREPLY=($(compgen -W "blender fan ears" -- "${cur}"))
                    return 0
                    ;;
                *)
                    COMPREPLY=()
                    ;;
            esac
            COMPREPLY=( $(compgen -W "${opts}" -- "${cur}") )
            return 0
            ;;
        darboux__subcmd__check)
            opts="-v -q -o -h --resume --retry --jobs --verbose --allow-outside --memory-limit --polygons --explain --only --allow --fail-on --convention --assume --no-maps --model --fix --dry-run --method --normals --report --json --quiet --output --out-dir --in-place --force --help"
            if [[ ${cur} == -* || ${COMP_CWORD} -eq 2 ]] ; then
                COMPREPLY=( $(compgen -W "${opts}" -- "${cur}") )
                return 0
            fi
            case "${prev}" in
                --jobs)
                    COMPREPLY=($(compgen -f "${cur}"))
                    return 0
                    ;;
                --memory-limit)
                    COMPREPLY=($(compgen -f "${cur}"))
                    return 0
                    ;;
                --polygons)
                    COMPREPLY=($(compgen -W "blender fan ears" -- "${cur}"))
                    return 0
                    ;;
                --explain)
                    COMPREPLY=($(compgen -W "tangent-not-finite tangent-zero tangent-not-unit tangent-not-perpendicular tangent-sign-not-one tangent-sign-mixed tangent-shared-across-mirror tangent-sign-flipped tangent-sign-flipped-where-mirrored tangent-sign-partly-flipped tangent-rotated tangent-negated tangent-other-uv-set tangent-other-recipe tangent-missing tangent-unused position-not-finite normal-missing normal-not-finite normal-not-unit normal-against-winding normal-other-axes uv-missing uv-not-finite uv-degenerate uv-mirrored uv-overlapping uv-stretched uv-coarse uv-rounded uv-hard-edge map-green-flipped map-detail-flipped map-red-flipped map-may-be-dents map-channels-swapped map-srgb map-height map-object-space map-not-normal map-two-channel map-not-unit map-negative-z map-flat-off map-flat map-enlarged map-banding map-blocks map-padding map-other-layout conventions-cancel map-unreadable map-scale-negative map-scale-zero map-scale-extreme transform-mirrors" -- "${cur}"))
                    return 0
                    ;;
                --only)
                    COMPREPLY=($(compgen -W "tangent-not-finite tangent-zero tangent-not-unit tangent-not-perpendicular tangent-sign-not-one tangent-sign-mixed tangent-shared-across-mirror tangent-sign-flipped tangent-sign-flipped-where-mirrored tangent-sign-partly-flipped tangent-rotated tangent-negated tangent-other-uv-set tangent-other-recipe tangent-missing tangent-unused position-not-finite normal-missing normal-not-finite normal-not-unit normal-against-winding normal-other-axes uv-missing uv-not-finite uv-degenerate uv-mirrored uv-overlapping uv-stretched uv-coarse uv-rounded uv-hard-edge map-green-flipped map-detail-flipped map-red-flipped map-may-be-dents map-channels-swapped map-srgb map-height map-object-space map-not-normal map-two-channel map-not-unit map-negative-z map-flat-off map-flat map-enlarged map-banding map-blocks map-padding map-other-layout conventions-cancel map-unreadable map-scale-negative map-scale-zero map-scale-extreme transform-mirrors" -- "${cur}"))
                    return 0
                    ;;
                --allow)
                    COMPREPLY=($(compgen -W "tangent-not-finite tangent-zero tangent-not-unit tangent-not-perpendicular tangent-sign-not-one tangent-sign-mixed tangent-shared-across-mirror tangent-sign-flipped tangent-sign-flipped-where-mirrored tangent-sign-partly-flipped tangent-rotated tangent-negated tangent-other-uv-set tangent-other-recipe tangent-missing tangent-unused position-not-finite normal-missing normal-not-finite normal-not-unit normal-against-winding normal-other-axes uv-missing uv-not-finite uv-degenerate uv-mirrored uv-overlapping uv-stretched uv-coarse uv-rounded uv-hard-edge map-green-flipped map-detail-flipped map-red-flipped map-may-be-dents map-channels-swapped map-srgb map-height map-object-space map-not-normal map-two-channel map-not-unit map-negative-z map-flat-off map-flat map-enlarged map-banding map-blocks map-padding map-other-layout conventions-cancel map-unreadable map-scale-negative map-scale-zero map-scale-extreme transform-mirrors" -- "${cur}"))
                    return 0
                    ;;
                --fail-on)
                    COMPREPLY=($(compgen -W "error warning never" -- "${cur}"))
                    return 0
                    ;;
                --convention)
                    COMPREPLY=($(compgen -W "opengl directx" -- "${cur}"))
                    return 0
                    ;;
                --assume)
                    COMPREPLY=($(compgen -W "map=opengl map=directx map=red-inverted map=both-inverted" -- "${cur}"))
                    return 0
                    ;;
                --model)
                    COMPREPLY=($(compgen -f "${cur}"))
                    return 0
                    ;;
                --method)
                    COMPREPLY=($(compgen -W "mikktspace angle-area lengyel lengyel-per-vertex average area face from-normal angle-edge" -- "${cur}"))
                    return 0
                    ;;
                --normals)
                    COMPREPLY=($(compgen -f "${cur}"))
                    return 0
                    ;;
                --report)
                    COMPREPLY=($(compgen -f "${cur}"))
                    return 0
                    ;;
                --output)
                    COMPREPLY=($(compgen -f "${cur}"))
                    return 0
                    ;;
                -o)
                    COMPREPLY=($(compgen -f "${cur}"))
                    return 0
                    ;;
                --out-dir)
                    COMPREPLY=($(compgen -f "${cur}"))
                    return 0
                    ;;
                *)
                    COMPREPLY=()
                    ;;
            esac
            COMPREPLY=( $(compgen -W "${opts}" -- "${cur}") )
            return 0
            ;;
        darboux__subcmd__compare)
            opts="-q -h --method --worst --tolerance --heat-map --force --allow-outside --memory-limit --polygons --json --quiet --help"
            if [[ ${cur} == -* || ${COMP_CWORD} -eq 2 ]] ; then
                COMPREPLY=( $(compgen -W "${opts}" -- "${cur}") )
                return 0
            fi
            case "${prev}" in
                --method)
                    COMPREPLY=($(compgen -W "mikktspace angle-area lengyel lengyel-per-vertex average area face from-normal angle-edge" -- "${cur}"))
                    return 0
                    ;;
                --worst)
                    COMPREPLY=($(compgen -f "${cur}"))
                    return 0
                    ;;
                --tolerance)
                    COMPREPLY=($(compgen -f "${cur}"))
                    return 0
                    ;;
                --heat-map)
                    COMPREPLY=($(compgen -f "${cur}"))
                    return 0
                    ;;
                --memory-limit)
                    COMPREPLY=($(compgen -f "${cur}"))
                    return 0
                    ;;
                --polygons)
                    COMPREPLY=($(compgen -W "blender fan ears" -- "${cur}"))
                    return 0
                    ;;
                *)
                    COMPREPLY=()
                    ;;
            esac
            COMPREPLY=( $(compgen -W "${opts}" -- "${cur}") )
            return 0
            ;;
        darboux__subcmd__completions)
            opts="-h --help bash elvish fish powershell zsh"
            if [[ ${cur} == -* || ${COMP_CWORD} -eq 2 ]] ; then
                COMPREPLY=( $(compgen -W "${opts}" -- "${cur}") )
                return 0
            fi
            case "${prev}" in
                *)
                    COMPREPLY=()
                    ;;
            esac
            COMPREPLY=( $(compgen -W "${opts}" -- "${cur}") )
            return 0
            ;;
        darboux__subcmd__convert)
            opts="-v -q -o -h --out-dir --in-place --force --resume --retry --jobs --verbose --allow-outside --memory-limit --polygons --from --to --layout --to-layout --space --model --uv-set --raw --json --quiet --output --help"
            if [[ ${cur} == -* || ${COMP_CWORD} -eq 2 ]] ; then
                COMPREPLY=( $(compgen -W "${opts}" -- "${cur}") )
                return 0
            fi
            case "${prev}" in
                --out-dir)
                    COMPREPLY=($(compgen -f "${cur}"))
                    return 0
                    ;;
                --jobs)
                    COMPREPLY=($(compgen -f "${cur}"))
                    return 0
                    ;;
                --memory-limit)
                    COMPREPLY=($(compgen -f "${cur}"))
                    return 0
                    ;;
                --polygons)
                    COMPREPLY=($(compgen -W "blender fan ears" -- "${cur}"))
                    return 0
                    ;;
                --from)
                    COMPREPLY=($(compgen -W "gltf opengl directx blender unity unreal godot threejs maya 3dsmax" -- "${cur}"))
                    return 0
                    ;;
                --to)
                    COMPREPLY=($(compgen -W "gltf opengl directx blender unity unreal godot threejs maya 3dsmax" -- "${cur}"))
                    return 0
                    ;;
                --layout)
                    COMPREPLY=($(compgen -f "${cur}"))
                    return 0
                    ;;
                --to-layout)
                    COMPREPLY=($(compgen -f "${cur}"))
                    return 0
                    ;;
                --space)
                    COMPREPLY=($(compgen -W "tangent object" -- "${cur}"))
                    return 0
                    ;;
                --model)
                    COMPREPLY=($(compgen -f "${cur}"))
                    return 0
                    ;;
                --uv-set)
                    COMPREPLY=($(compgen -f "${cur}"))
                    return 0
                    ;;
                --output)
                    COMPREPLY=($(compgen -f "${cur}"))
                    return 0
                    ;;
                -o)
                    COMPREPLY=($(compgen -f "${cur}"))
                    return 0
                    ;;
                *)
                    COMPREPLY=()
                    ;;
            esac
            COMPREPLY=( $(compgen -W "${opts}" -- "${cur}") )
            return 0
            ;;
        darboux__subcmd__devices)
            opts="-h --json --help"
            if [[ ${cur} == -* || ${COMP_CWORD} -eq 2 ]] ; then
                COMPREPLY=( $(compgen -W "${opts}" -- "${cur}") )
                return 0
            fi
            case "${prev}" in
                *)
                    COMPREPLY=()
                    ;;
            esac
            COMPREPLY=( $(compgen -W "${opts}" -- "${cur}") )
            return 0
            ;;
        darboux__subcmd__inspect)
            opts="-q -h --allow-outside --memory-limit --polygons --json --quiet --help"
            if [[ ${cur} == -* || ${COMP_CWORD} -eq 2 ]] ; then
                COMPREPLY=( $(compgen -W "${opts}" -- "${cur}") )
                return 0
            fi
            case "${prev}" in
                --memory-limit)
                    COMPREPLY=($(compgen -f "${cur}"))
                    return 0
                    ;;
                --polygons)
                    COMPREPLY=($(compgen -W "blender fan ears" -- "${cur}"))
                    return 0
                    ;;
                *)
                    COMPREPLY=()
                    ;;
            esac
            COMPREPLY=( $(compgen -W "${opts}" -- "${cur}") )
            return 0
            ;;
        darboux__subcmd__methods)
            opts="-h --help"
            if [[ ${cur} == -* || ${COMP_CWORD} -eq 2 ]] ; then
                COMPREPLY=( $(compgen -W "${opts}" -- "${cur}") )
                return 0
            fi
            case "${prev}" in
                *)
                    COMPREPLY=()
                    ;;
            esac
            COMPREPLY=( $(compgen -W "${opts}" -- "${cur}") )
            return 0
            ;;
        darboux__subcmd__normals)
            opts="-o -v -q -h --output --out-dir --in-place --force --resume --retry --jobs --verbose --allow-outside --memory-limit --polygons --normals --weight --respect-seams --overwrite --json --quiet --help"
            if [[ ${cur} == -* || ${COMP_CWORD} -eq 2 ]] ; then
                COMPREPLY=( $(compgen -W "${opts}" -- "${cur}") )
                return 0
            fi
            case "${prev}" in
                --output)
                    COMPREPLY=($(compgen -f "${cur}"))
                    return 0
                    ;;
                -o)
                    COMPREPLY=($(compgen -f "${cur}"))
                    return 0
                    ;;
                --out-dir)
                    COMPREPLY=($(compgen -f "${cur}"))
                    return 0
                    ;;
                --jobs)
                    COMPREPLY=($(compgen -f "${cur}"))
                    return 0
                    ;;
                --memory-limit)
                    COMPREPLY=($(compgen -f "${cur}"))
                    return 0
                    ;;
                --polygons)
                    COMPREPLY=($(compgen -W "blender fan ears" -- "${cur}"))
                    return 0
                    ;;
                --normals)
                    COMPREPLY=($(compgen -f "${cur}"))
                    return 0
                    ;;
                --weight)
                    COMPREPLY=($(compgen -W "angle area angle-area" -- "${cur}"))
                    return 0
                    ;;
                *)
                    COMPREPLY=()
                    ;;
            esac
            COMPREPLY=( $(compgen -W "${opts}" -- "${cur}") )
            return 0
            ;;
        darboux__subcmd__render)
            opts="-o -q -h --output --view --tangents --against --split --lines --length --seams --ground --layout --mistakes --mesh --size --camera --look --background --no-legend --force --allow-outside --memory-limit --polygons --json --quiet --help"
            if [[ ${cur} == -* || ${COMP_CWORD} -eq 2 ]] ; then
                COMPREPLY=( $(compgen -W "${opts}" -- "${cur}") )
                return 0
            fi
            case "${prev}" in
                --output)
                    COMPREPLY=($(compgen -f "${cur}"))
                    return 0
                    ;;
                -o)
                    COMPREPLY=($(compgen -f "${cur}"))
                    return 0
                    ;;
                --view)
                    COMPREPLY=($(compgen -W "shaded bumps tangent bitangent normal sign angle" -- "${cur}"))
                    return 0
                    ;;
                --tangents)
                    COMPREPLY=($(compgen -f "${cur}"))
                    return 0
                    ;;
                --against)
                    COMPREPLY=($(compgen -f "${cur}"))
                    return 0
                    ;;
                --split)
                    COMPREPLY=($(compgen -f "${cur}"))
                    return 0
                    ;;
                --lines)
                    COMPREPLY=($(compgen -W "tangent bitangent normal" -- "${cur}"))
                    return 0
                    ;;
                --length)
                    COMPREPLY=($(compgen -f "${cur}"))
                    return 0
                    ;;
                --layout)
                    COMPREPLY=($(compgen -W "corner alone" -- "${cur}"))
                    return 0
                    ;;
                --mistakes)
                    COMPREPLY=($(compgen -W "green w v columns sign-noise no-guard both-negated uv-not-inverted edge-twice without-w normal-matrix race no-bounds-check adjacency-offsets long-normals one-tangent last-corner" -- "${cur}"))
                    return 0
                    ;;
                --mesh)
                    COMPREPLY=($(compgen -f "${cur}"))
                    return 0
                    ;;
                --size)
                    COMPREPLY=($(compgen -f "${cur}"))
                    return 0
                    ;;
                --camera)
                    COMPREPLY=($(compgen -f "${cur}"))
                    return 0
                    ;;
                --look)
                    COMPREPLY=($(compgen -f "${cur}"))
                    return 0
                    ;;
                --background)
                    COMPREPLY=($(compgen -f "${cur}"))
                    return 0
                    ;;
                --memory-limit)
                    COMPREPLY=($(compgen -f "${cur}"))
                    return 0
                    ;;
                --polygons)
                    COMPREPLY=($(compgen -W "blender fan ears" -- "${cur}"))
                    return 0
                    ;;
                *)
                    COMPREPLY=()
                    ;;
            esac
            COMPREPLY=( $(compgen -W "${opts}" -- "${cur}") )
            return 0
            ;;
        darboux__subcmd__report)
            opts="-o -q -h --output --force --pictures --only --allow --fail-on --convention --assume --no-maps --allow-outside --memory-limit --polygons --quiet --help"
            if [[ ${cur} == -* || ${COMP_CWORD} -eq 2 ]] ; then
                COMPREPLY=( $(compgen -W "${opts}" -- "${cur}") )
                return 0
            fi
            case "${prev}" in
                --output)
                    COMPREPLY=($(compgen -f "${cur}"))
                    return 0
                    ;;
                -o)
                    COMPREPLY=($(compgen -f "${cur}"))
                    return 0
                    ;;
                --pictures)
                    COMPREPLY=($(compgen -f "${cur}"))
                    return 0
                    ;;
                --only)
                    COMPREPLY=($(compgen -W "tangent-not-finite tangent-zero tangent-not-unit tangent-not-perpendicular tangent-sign-not-one tangent-sign-mixed tangent-shared-across-mirror tangent-sign-flipped tangent-sign-flipped-where-mirrored tangent-sign-partly-flipped tangent-rotated tangent-negated tangent-other-uv-set tangent-other-recipe tangent-missing tangent-unused position-not-finite normal-missing normal-not-finite normal-not-unit normal-against-winding normal-other-axes uv-missing uv-not-finite uv-degenerate uv-mirrored uv-overlapping uv-stretched uv-coarse uv-rounded uv-hard-edge map-green-flipped map-detail-flipped map-red-flipped map-may-be-dents map-channels-swapped map-srgb map-height map-object-space map-not-normal map-two-channel map-not-unit map-negative-z map-flat-off map-flat map-enlarged map-banding map-blocks map-padding map-other-layout conventions-cancel map-unreadable map-scale-negative map-scale-zero map-scale-extreme transform-mirrors" -- "${cur}"))
                    return 0
                    ;;
                --allow)
                    COMPREPLY=($(compgen -W "tangent-not-finite tangent-zero tangent-not-unit tangent-not-perpendicular tangent-sign-not-one tangent-sign-mixed tangent-shared-across-mirror tangent-sign-flipped tangent-sign-flipped-where-mirrored tangent-sign-partly-flipped tangent-rotated tangent-negated tangent-other-uv-set tangent-other-recipe tangent-missing tangent-unused position-not-finite normal-missing normal-not-finite normal-not-unit normal-against-winding normal-other-axes uv-missing uv-not-finite uv-degenerate uv-mirrored uv-overlapping uv-stretched uv-coarse uv-rounded uv-hard-edge map-green-flipped map-detail-flipped map-red-flipped map-may-be-dents map-channels-swapped map-srgb map-height map-object-space map-not-normal map-two-channel map-not-unit map-negative-z map-flat-off map-flat map-enlarged map-banding map-blocks map-padding map-other-layout conventions-cancel map-unreadable map-scale-negative map-scale-zero map-scale-extreme transform-mirrors" -- "${cur}"))
                    return 0
                    ;;
                --fail-on)
                    COMPREPLY=($(compgen -W "error warning never" -- "${cur}"))
                    return 0
                    ;;
                --convention)
                    COMPREPLY=($(compgen -W "opengl directx" -- "${cur}"))
                    return 0
                    ;;
                --assume)
                    COMPREPLY=($(compgen -W "map=opengl map=directx map=red-inverted map=both-inverted" -- "${cur}"))
                    return 0
                    ;;
                --memory-limit)
                    COMPREPLY=($(compgen -f "${cur}"))
                    return 0
                    ;;
                --polygons)
                    COMPREPLY=($(compgen -W "blender fan ears" -- "${cur}"))
                    return 0
                    ;;
                *)
                    COMPREPLY=()
                    ;;
            esac
            COMPREPLY=( $(compgen -W "${opts}" -- "${cur}") )
            return 0
            ;;
        darboux__subcmd__tangents)
            opts="-o -v -q -h --output --out-dir --in-place --force --resume --retry --jobs --verbose --allow-outside --memory-limit --polygons --method --mode --threshold --device --normals --encoding --overwrite --only-needed --apply-texture-transform --strict --json --quiet --help"
            if [[ ${cur} == -* || ${COMP_CWORD} -eq 2 ]] ; then
                COMPREPLY=( $(compgen -W "${opts}" -- "${cur}") )
                return 0
            fi
            case "${prev}" in
                --output)
                    COMPREPLY=($(compgen -f "${cur}"))
                    return 0
                    ;;
                -o)
                    COMPREPLY=($(compgen -f "${cur}"))
                    return 0
                    ;;
                --out-dir)
                    COMPREPLY=($(compgen -f "${cur}"))
                    return 0
                    ;;
                --jobs)
                    COMPREPLY=($(compgen -f "${cur}"))
                    return 0
                    ;;
                --memory-limit)
                    COMPREPLY=($(compgen -f "${cur}"))
                    return 0
                    ;;
                --polygons)
                    COMPREPLY=($(compgen -W "blender fan ears" -- "${cur}"))
                    return 0
                    ;;
                --method)
                    COMPREPLY=($(compgen -W "mikktspace angle-area lengyel lengyel-per-vertex average area face from-normal angle-edge" -- "${cur}"))
                    return 0
                    ;;
                --mode)
                    COMPREPLY=($(compgen -W "repaired reference corrected" -- "${cur}"))
                    return 0
                    ;;
                --threshold)
                    COMPREPLY=($(compgen -f "${cur}"))
                    return 0
                    ;;
                --device)
                    COMPREPLY=($(compgen -W "auto cpu gpu" -- "${cur}"))
                    return 0
                    ;;
                --normals)
                    COMPREPLY=($(compgen -f "${cur}"))
                    return 0
                    ;;
                --encoding)
                    COMPREPLY=($(compgen -W "f32x4 snorm16x4 snorm8x4" -- "${cur}"))
                    return 0
                    ;;
                *)
                    COMPREPLY=()
                    ;;
            esac
            COMPREPLY=( $(compgen -W "${opts}" -- "${cur}") )
            return 0
            ;;
        darboux__subcmd__view)
            opts="-h --high --no-open --allow-outside --memory-limit --polygons --page --help"
            if [[ ${cur} == -* || ${COMP_CWORD} -eq 2 ]] ; then
                COMPREPLY=( $(compgen -W "${opts}" -- "${cur}") )
                return 0
            fi
            case "${prev}" in
                --high)
                    COMPREPLY=($(compgen -f "${cur}"))
                    return 0
                    ;;
                --memory-limit)
                    COMPREPLY=($(compgen -f "${cur}"))
                    return 0
                    ;;
                --polygons)
                    COMPREPLY=($(compgen -W "blender fan ears" -- "${cur}"))
                    return 0
                    ;;
                --page)
                    COMPREPLY=($(compgen -f "${cur}"))
                    return 0
                    ;;
                *)
                    COMPREPLY=()
                    ;;
            esac
            COMPREPLY=( $(compgen -W "${opts}" -- "${cur}") )
            return 0
            ;;
    esac
}

if [[ "${BASH_VERSINFO[0]}" -eq 4 && "${BASH_VERSINFO[1]}" -ge 4 || "${BASH_VERSINFO[0]}" -gt 4 ]]; then
    complete -F _darboux -o nosort -o bashdefault -o default darboux
else
    complete -F _darboux -o bashdefault -o default darboux
fi
