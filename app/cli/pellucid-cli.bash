# bash completion for pellucid-cli
# Commands, options and samples are asked of the program itself, so that this file never lags behind it.

_pellucid_cli() {
    local program=${COMP_WORDS[0]}
    # Bash splits words at ':' and '='; the line as typed has them whole.
    local line=${COMP_LINE:0:COMP_POINT}
    local current=${line##*[[:space:]]}
    local -a words
    read -r -a words <<<"$line"
    local count=${#words[@]}
    [[ -n $current ]] && ((count--))
    local previous=${words[count-1]}
    local choices=

    if ((count <= 1)); then
        choices="$("$program" --help 2>/dev/null | sed -n '/^Subcommands:/,/^$/s/^  \([a-z-]*\) .*/\1/p') --help --version"
        COMPREPLY=($(compgen -W "$choices" -- "$current"))
        return
    fi
    local command=${words[1]}
    if [[ $command == study ]]; then
        if ((count == 2)); then
            choices=$("$program" study --help 2>/dev/null | sed -n '/^Subcommands:/,/^$/s/^  \([a-z-]*\) .*/\1/p')
            COMPREPLY=($(compgen -W "$choices --help" -- "$current"))
            return
        fi
        command="study ${words[2]}"
    fi

    case $previous in
        --field-colormap) choices="feature hue spiral ember sand grey blue-orange blue-red" ;;
        --scale) choices="linear log log:" ;;
        --paths) choices="newton parallel line fixed runs" ;;
        --show) choices="F" ;;
        --hsb) choices="saturation= brightness= hue= alpha= off" ;;
        --features-of) choices="gradient volatility: difference: gradient: x" ;;
        --ground-map) choices="terrain hue spiral ember sand grey blue-orange blue-red" ;;
        --ground)
            choices=$("$program" samples 2>/dev/null | sed -n 's/^\(sample:[^ ]*\) .*/\1/p')
            COMPREPLY=($(compgen -W "$choices none" -- "$current") $(compgen -f -- "$current"))
            choices=
            compopt -o filenames 2>/dev/null
            ;;
        --colormap) choices="hue spiral ember sand grey blue-orange blue-red categorical" ;;
        --only)
            [[ $command == bench ]] || return
            choices="setup saliency saliency-direct sweep slices jacobian optimize optimize-newton threads optimize-whole refine refine-500 refine-1000 refine-direct render preview"
            ;;
        --to) choices="paraview slicer slicer-vp slicer-xml voreen paraview-xml inviwo niivue vtkjs csv imagevis3d mitk itksnap pellucid" ;;
        --slice) choices="x: y: z:" ;;
        --target) choices="equal diagonal inside-out only:" ;;
        --annotate) choices="all cube letters axes scale legend title measures" ;;
        --view)
            choices="anterior posterior left right superior inferior front back top bottom"
            [[ $command == optimize ]] && choices+=" best"
            ;;
        --tf)
            choices="auto tents: ramp: $("$program" presets 2>/dev/null | sed -n 's/^\(preset:[^ ]*\) .*/\1/p')"
            COMPREPLY=($(compgen -W "$choices" -- "$current") $(compgen -f -- "$current"))
            choices=
            compopt -o filenames -o nospace 2>/dev/null
            ;;
        --camera | --session | --out | --out-tf | --out-camera | --map | --save | --csv | --report | --curves | --bars | --plot | --mp4)
            COMPREPLY=($(compgen -f -- "$current"))
            compopt -o filenames 2>/dev/null
            return
            ;;
        --*)
            # What the program's help gives as the option's value: its words are choices; of a flag there is none.
            local value
            value=$("$program" $command --help 2>/dev/null | sed -n "s/^  $previous  *\([^ ]*\).*/\1/p" | head -n 1)
            if [[ $value == *[A-Z]* || $value == *"|"* ]]; then
                choices=$(tr '|' '\n' <<<"$value" | grep -E '^[a-z][a-z-]*$')
                [[ -n $choices ]] || return
            fi
            ;;
    esac

    if [[ -n $choices ]]; then
        COMPREPLY=($(compgen -W "$choices" -- "$current"))
    elif [[ $current == -* ]]; then
        choices=$("$program" $command --help 2>/dev/null | grep -oE -- '--[a-z][a-z0-9-]*' | sort -u)
        COMPREPLY=($(compgen -W "$choices" -- "$current"))
    elif [[ $command == reproduce ]]; then
        choices=$("$program" reproduce --list 2>/dev/null | sed 's/  .*//')
        COMPREPLY=($(compgen -W "$choices" -- "$current"))
    elif [[ $command == generate ]]; then
        choices=$("$program" samples 2>/dev/null | sed -n 's/^sample:\([^ ]*\) .*/\1/p')
        COMPREPLY=($(compgen -W "$choices" -- "$current"))
    elif [[ $command == study* ]]; then
        COMPREPLY=($(compgen -f -- "$current"))
        compopt -o filenames 2>/dev/null
    elif [[ $command != samples && $command != presets && $previous != --tf && $previous != --ground ]]; then
        choices=$("$program" samples 2>/dev/null | sed -n 's/^\(sample:[^ ]*\) .*/\1/p')
        COMPREPLY=($(compgen -W "$choices" -- "$current") $(compgen -f -- "$current"))
        compopt -o filenames 2>/dev/null
    fi

    # What bash has split off before a ':' is not part of the word it replaces.
    if [[ $current == *:* && $COMP_WORDBREAKS == *:* ]]; then
        local prefix=${current%"${current##*:}"}
        local i
        for i in "${!COMPREPLY[@]}"; do COMPREPLY[i]=${COMPREPLY[i]#"$prefix"}; done
    fi
}

complete -F _pellucid_cli pellucid-cli
