#!/usr/bin/env bash
# Lists the libraries that each program is linked with on Debian, and their licences: scripts/licences.sh [BUILD]
# writes docs/licences.md. The licences are the short names in /usr/share/doc/PACKAGE/copyright, which speaks of the
# whole source package; where that file has no such names, what its text mentions.
set -euo pipefail
cd "$(dirname "$0")/.."
build=${1:-build/release}
out=docs/licences.md
# Each with the letter that stands for it in the table.
programs=() letters=()
while read -r letter program; do
    letters+=("$letter") programs+=("$program")
done <<'END'
c pellucid-cli
w pellucid
d pellucid-reader
t pellucid-tiff-reader
p pellucid-image-reader
a pellucid-array-reader
i pellucid_image_codecs.so
f pellucid_print.so
END
headers=(libcli11-dev libeigen3-dev libglm-dev nlohmann-json3-dev)

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# The packages of the libraries that are read; Debian 12 knows some by their place before /lib became /usr/lib.
packages_of() {
    local library path
    while read -r library; do
        path=${library#/usr}
        printf '%s\n' "$path" "/usr$path"
    done | xargs dpkg -S 2>/dev/null | sed 's/[:,].*//' | LC_ALL=C sort -u
}

licences_of() {
    local file=/usr/share/doc/$1/copyright names
    [ -r "$file" ] || { echo "not told" && return; }
    names=$(sed -n 's/^[Ll]icen[cs]e: *\([^ ].*\)$/\1/p' "$file" | sed 's/,* *$//' | LC_ALL=C sort -u | paste -sd';' | sed 's/;/; /g')
    if [ -z "$names" ]; then
        names=$(for word in 'GNU Lesser General Public' 'GNU Library General Public' 'GNU General Public' 'Apache License' \
            'Mozilla Public' 'BSD' 'MIT' 'zlib' 'public domain' 'Permission is hereby granted, free of charge' \
            'Redistribution and use in source and binary forms'; do
            ! grep -qi "$word" "$file" || echo "$word"
        done | sed 's/^Permission is hereby.*/MIT or alike/; s/^Redistribution and use.*/BSD or alike/' |
            LC_ALL=C sort -u | paste -sd';' | sed 's/;/; /g')
        names="${names:-see the file} (mentioned)"
    fi
    echo "${names//|//}"
}

for program in "${programs[@]}"; do
    [ -e "$build/bin/$program" ] || { echo "licences: $build/bin/$program is missing, build it first" >&2 && exit 1; }
    ldd "$build/bin/$program" | sed -n 's/.*=> \(\/[^ ]*\) .*/\1/p; s/^\s*\(\/[^ ]*ld-linux[^ ]*\) .*/\1/p' |
        LC_ALL=C sort -u >"$work/$program.libraries"
    packages_of <"$work/$program.libraries" >"$work/$program" || true # it knows one of both places
done

{
    echo "# Licences"
    echo
    echo "Pellucid is under the [Apache License 2.0](../LICENSE). Its programs are linked with libraries under other licences,"
    echo "on Debian $(. /etc/os-release && echo "$VERSION_ID") with those below; made by \`scripts/licences.sh\`. The names are those of Debian's copyright files,"
    echo "which speak of whole source packages, with their build files and tests: a library often has only the first of them."
    echo "*(mentioned)*: the file has no short names, and its text speaks of these."
    echo
    echo "What a program loads when it runs (drivers of OpenGL, styles and platforms of Qt) is not among them."
    echo
    echo "## How many"
    echo
    echo "| program | libraries | packages |"
    echo "|---|---:|---:|"
    for program in "${programs[@]}"; do
        echo "| \`$program\` | $(wc -l <"$work/$program.libraries") | $(wc -l <"$work/$program") |"
    done
    echo
    echo "## Compiled in"
    echo
    echo "Headers of these become part of all programs."
    echo
    echo "| package | licences |"
    echo "|---|---|"
    for package in "${headers[@]}"; do echo "| $package | $(licences_of "$package") |"; done
    echo
    echo "## Linked"
    echo
    echo "c: \`pellucid-cli\`; w: the window, \`pellucid\`; d, t, p, a: \`pellucid-reader\` (DICOM), \`-tiff-\`, \`-image-\` and"
    echo "\`-array-reader\`; i: \`pellucid_image_codecs.so\`, which both programs load when they read a picture or write another than PNG;"
    echo "f: \`pellucid_print.so\`, which they load when they make a figure for print. Through OpenImageIO, p and i come with libraries"
    echo "that Debian builds under the GPL (FFmpeg, x264, x265): they are a package of their own, pellucid-images, which all but figures"
    echo "for print, folders of pictures and EXR, TIFF and JPEG pictures do without."
    echo
    echo "| package | programs | licences |"
    echo "|---|---|---|"
    cat "${programs[@]/#/$work/}" | LC_ALL=C sort -u | while read -r package; do
        of=
        for i in "${!programs[@]}"; do
            ! grep -qxF "$package" "$work/${programs[i]}" || of+=${letters[i]}
        done
        echo "| $package | $of | $(licences_of "$package") |"
    done
} >"$work/page"
cp "$work/page" $out
echo "wrote $out: $(grep -c '^| lib' $out) packages"
