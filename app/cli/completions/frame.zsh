#compdef pellucid-cli
# zsh completion for pellucid-cli, made by `pellucid-cli completions zsh`

# files, folders or none; then words to choose from
_pellucid_cli_offer() {
    local where=$1
    local -a ends goes_on
    shift
    ends=(${@:#*[:=]})
    goes_on=(${(M)@:#*[:=]})
    compadd -a ends
    compadd -S '' -a goes_on
    case $where in
        files) _files ;;
        folders) _files -/ ;;
    esac
}

@TABLES@

_pellucid_cli() {
    local command=
    if (( CURRENT > 2 )); then
        command=$words[2]
        shift words
        (( CURRENT-- ))
    fi
    if [[ $command == study ]] && (( CURRENT > 2 )); then
        command+=" $words[2]"
        shift words
        (( CURRENT-- ))
    fi
    case $command in
        '' | study) _pellucid_cli_commands "$command" ;;
        *) _pellucid_cli_options "$command" ;;
    esac
}

_pellucid_cli "$@"
