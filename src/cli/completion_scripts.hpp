#pragma once

#include <string_view>

namespace doppel {

// The output of "doppel completion"; each script calls "doppel complete WORD…".

inline constexpr std::string_view bash_script = R"(# Completion of doppel for bash: source <(doppel completion bash)
_doppel() {
    local program=${COMP_WORDS[0]} line=${COMP_LINE:0:COMP_POINT} words word quote before= _
    if [[ $program == ./doppel && -x build/release/doppel ]]; then program=build/release/doppel; fi  # without building it
    read -a words <<<"$line"
    if [[ $line == *[[:space:]] ]]; then words+=(''); fi
    word=${words[-1]} quote=${word%%[!\'\"]*}
    if [[ ! $quote ]]; then before=${word%"${word##*[=:]}"}; fi  # bash replaces what stands behind its last cut alone
    words=("${words[@]//[\"\']/}")
    for _ in key value; do
        COMPREPLY=()
        while IFS=$'\t' read -r word _; do
            word=${word#"$before"}
            if [[ ! $quote ]]; then printf -v word %q "$word" && word=${word//\\,/,}; fi
            COMPREPLY+=("$word")
        done < <("$program" complete "${words[@]:1}" 2>/dev/null)
        # bash closes a quote behind a single word, and after a key it would have to be opened again
        if [[ ! $quote || ${#COMPREPLY[@]} != 1 || ${COMPREPLY[0]} != *= ]]; then break; fi
        words[-1]=${COMPREPLY[0]}
    done
    # the word goes on after a key, a table or a folder
    if [[ ${#COMPREPLY[@]} == 1 && ${COMPREPLY[0]} == *[=/] ]]; then compopt -o nospace 2>/dev/null; fi
    return 0
}
complete -F _doppel doppel ./doppel
)";

inline constexpr std::string_view zsh_script = R"(#compdef doppel
# Completion of doppel for zsh: source <(doppel completion zsh), or as a file _doppel in a folder of $fpath
_doppel() {
    local line
    local -a open whole open_help whole_help
    for line in "${(@f)$("${words[1]}" complete "${(@)${(@Q)words[2,CURRENT]}//[\"\']/}" 2>/dev/null)}"; do
        [[ -n $line ]] || continue
        if [[ ${line%%$'\t'*} == *[=/] ]]; then
            open+=("${line%%$'\t'*}") open_help+=("${line/$'\t'/  }")
        else
            whole+=("${line%%$'\t'*}") whole_help+=("${line/$'\t'/  }")
        fi
    done
    compadd -l -d open_help -S '' -a open
    compadd -l -d whole_help -a whole
}
if [[ $funcstack[1] == _doppel ]]; then _doppel "$@"; else compdef _doppel doppel; fi
)";

inline constexpr std::string_view fish_script = R"(# Completion of doppel for fish: doppel completion fish | source
function __doppel_complete
    set -l words (commandline -opc) (commandline -ct)
    $words[1] complete (string replace -ra '[\'"\\\\]' '' -- $words[2..-1]) 2>/dev/null
end
complete -c doppel -f -a '(__doppel_complete)'
)";

}  // namespace doppel
