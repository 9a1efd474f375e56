# bash completion for pellucid-cli, made by `pellucid-cli completions bash`

# Each of these sets words (to choose from), files and folders.
@TABLES@

_pellucid_cli() {
    # Bash splits words at ':' and '='; the line as typed has them whole.
    local line=${COMP_LINE:0:COMP_POINT}
    local current=${line##*[[:space:]]}
    local -a typed
    read -r -a typed <<<"$line"
    local count=${#typed[@]}
    [[ -n $current ]] && ((count--))
    local previous=${typed[count-1]}
    local words= files= folders= parent= command=

    local i
    for ((i = 1; i < count; i++)); do
        parent=
        _pellucid_cli_options "$command"
        [[ -n $parent ]] || break
        command+=${command:+ }${typed[i]}
    done

    words= parent=
    if ! _pellucid_cli_values "$command $previous"; then
        words=
        _pellucid_cli_options "$command"
        if [[ -z $parent && $current != -* ]]; then
            words=
            _pellucid_cli_arguments "$command"
        fi
    fi
    COMPREPLY=($(compgen -W "$words" -- "$current"))
    [[ -z $files ]] || COMPREPLY+=($(compgen -f -- "$current"))
    [[ -z $folders || -n $files ]] || COMPREPLY+=($(compgen -d -- "$current"))
    [[ -z $files$folders ]] || compopt -o filenames 2>/dev/null
    [[ ${COMPREPLY[0]} != *[:=] ]] || compopt -o nospace 2>/dev/null

    # What bash has split off before a ':' is not part of the word it replaces.
    if [[ $current == *:* && $COMP_WORDBREAKS == *:* ]]; then
        local prefix=${current%"${current##*:}"}
        for i in "${!COMPREPLY[@]}"; do COMPREPLY[i]=${COMPREPLY[i]#"$prefix"}; done
    fi
}

complete -F _pellucid_cli pellucid-cli
