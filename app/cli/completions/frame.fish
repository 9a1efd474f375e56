# fish completion for pellucid-cli, made by `pellucid-cli completions fish`

# Whether the line is at this command: no words before the first one is typed, two in `study run`.
function __pellucid_cli_at
    set -l typed (commandline -opc)
    set -l command $typed[2]
    if test "$command" = study; and set -q typed[3]
        set command $command $typed[3]
    end
    test "$command" = "$argv"
end

complete -c pellucid-cli -f
@TABLES@
