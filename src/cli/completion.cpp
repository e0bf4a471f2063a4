#include "base/error.hpp"
#include "cli/options.hpp"
#include "embedded/cli.hpp"
#include "scene/preset_fields.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <sstream>
#include <string_view>

namespace doppel {
namespace {

namespace fs = std::filesystem;

struct Candidate {
    std::string text, help = {};
};
using Candidates = std::vector<Candidate>;

/// Built-in presets and those in this folder, of the kind that the command accepts.
void add_presets(const std::string& command, Candidates& all) {
    const bool films = command != "figure", figures = command == "figure" || command == "check" || command == "show";
    if (command == "figure") all.push_back({"all", "every figure that is built in"});
    auto files = preset_files_here();
    for (const auto& preset : builtin_presets()) files.emplace_back(preset.path);
    for (const auto& file : files) {
        const bool is_figure = file.parent_path() == "presets/figures";
        if (is_figure ? figures : films) all.push_back({file.stem().string(), is_figure ? "figure" : "film"});
    }
}

/// Folders and files with this extension that begin with the word.
void add_files(const std::string& word, std::string_view ending, Candidates& all) {
    const auto folder = word.substr(0, word.rfind('/') + 1);
    const bool wants_hidden = fs::path(word).filename().string().starts_with('.');
    std::error_code ignored;
    for (const auto& entry : fs::directory_iterator(folder.empty() ? "." : folder, ignored)) {
        const auto name = entry.path().filename().string();
        if (name.starts_with('.') && !wants_hidden) continue;
        if (entry.is_directory(ignored))
            all.push_back({folder + name + "/"});
        else if (name.ends_with(ending))
            all.push_back({folder + name});
    }
}

/// The choices listed in the description of a check such as CLI::IsMember: "{mp4,webm}".
void add_choices(const CLI::Option& option, const std::string& before, Candidates& all) {
    auto text = option.get_type_name();  // descriptions of other checks follow a colon
    const auto open = text.find('{'), close = text.find('}');
    if (open == std::string::npos || close == std::string::npos) return;
    text = text.substr(open + 1, close - open - 1);
    for (const auto& choice : CLI::detail::split(text, ',')) all.push_back({before + choice});
}

/// The kinds that --set may apply to: that of the first word that is a readable preset, or those that the command
/// accepts.
std::vector<std::string> kinds_of(const std::string& command, const std::vector<std::string>& words) {
    for (std::size_t i = 1; i + 1 < words.size(); ++i) {
        if (words[i].starts_with('-') || words[i - 1].starts_with('-')) continue;
        try {
            return {kind_of_preset(find_preset(words[i]))};
        } catch (const Error&) {
            continue;  // the value of an option, or an incomplete name
        }
    }
    if (command != "figure") return {std::string(pair_kind)};
    return {scene_kinds.begin() + 1, scene_kinds.end()};
}

/// "table.key=", or the values of the key if it is complete. The list is made by tests/figure/starting_presets.cpp.
void add_settings(const std::string& command, const std::vector<std::string>& words, const std::string& word,
                  Candidates& all) {
    const auto kinds = kinds_of(command, words);
    const auto word_key = word.substr(0, word.find('=') + 1);
    bool is_axis = false;  // its value is a key of a side
    Candidates of_sides;
    std::istringstream lines{std::string(embedded_file(cli_files(), "settings.tsv"))};
    for (std::string line; std::getline(lines, line);) {
        const auto cells = CLI::detail::split(line, '\t');  // kind, key, help, values
        const auto key = cells[1] + '=';
        if (std::ranges::find(kinds, cells[0]) == kinds.end()) continue;
        const bool is_complete = word.starts_with(key);
        if (!is_complete) all.push_back({key, cells[2]});
        for (std::size_t i = 3; is_complete && i < cells.size(); ++i) all.push_back({key + cells[i]});
        is_axis |= is_complete && key.ends_with(".key=");
        if (key.starts_with("system.") || key.starts_with("a.") || key.starts_with("b."))
            of_sides.push_back({word_key + cells[1], cells[2]});
    }
    if (is_axis) all.insert(all.end(), of_sides.begin(), of_sides.end());
}

void add_values(const CLI::Option& option, const std::string& command, const std::vector<std::string>& words,
                const std::string& word, const std::string& before, Candidates& all) {
    if (option.get_name() == "--render") return add_presets("check", all);
    if (option.get_name() == "--set") return add_settings(command, words, word, all);
    add_choices(option, before, all);
    if (option.get_type_name() == "DIR") add_files(word, "/", all);  // only folders
}

/// Completions of the last of `words`, which begin with the command.
Candidates candidates(CLI::App& app, const std::vector<std::string>& words) {
    Candidates all;
    const auto& word = words.back();
    CLI::App* command = words.size() == 1 ? &app : nullptr;
    for (auto* each : app.get_subcommands({}))
        if (words.size() == 1)
            all.push_back({each->get_name(), each->get_description()});
        else if (each->get_name() == words[0])
            command = each;
    if (!command) return all;
    // the value of an option: a word after it, or --option=value
    const auto equals = word.starts_with("--") ? word.find('=') : std::string::npos;
    const bool has_value = equals != std::string::npos;
    const auto name = has_value ? word.substr(0, equals) : words.size() > 1 ? words[words.size() - 2] : "";
    const auto* taking = name.starts_with('-') ? command->get_option_no_throw(name) : nullptr;
    const bool takes = taking && taking->get_items_expected_max() > 0;
    if (takes) add_values(*taking, words[0], words, word, has_value ? word.substr(0, equals + 1) : "", all);
    if (takes || has_value) return all;
    for (const auto* option : command->get_options()) {
        if (!option->get_positional()) {
            for (const auto& name : option->get_lnames()) all.push_back({"--" + name, option->get_description()});
            continue;
        }
        add_choices(*option, "", all);
        const auto name = option->get_name();
        if (name == "PRESET") add_presets(words[0], all);
        if (option->get_type_name().find('{') == std::string::npos)
            add_files(word, name == "PRESET" || name == "FILE" ? ".toml" : name == "TRACK" ? ".csv" : "", all);
    }
    if (!word.starts_with('-')) std::erase_if(all, [](const Candidate& one) { return one.text.starts_with('-'); });
    return all;
}

// The output of "doppel completion"; each script calls "doppel complete WORD…".

constexpr std::string_view bash_script = R"(# Completion of doppel for bash: source <(doppel completion bash)
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

constexpr std::string_view zsh_script = R"(#compdef doppel
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

constexpr std::string_view fish_script = R"(# Completion of doppel for fish: doppel completion fish | source
function __doppel_complete
    set -l words (commandline -opc) (commandline -ct)
    $words[1] complete (string replace -ra '[\'"\\\\]' '' -- $words[2..-1]) 2>/dev/null
end
complete -c doppel -f -a '(__doppel_complete)'
)";

}  // namespace

std::string completions(CLI::App& app, const std::vector<std::string>& words) {
    if (words.empty()) return "";
    std::vector<std::string> lines;
    for (const auto& [text, help] : candidates(app, words)) {
        auto unquoted = text;  // as the words are
        std::erase(unquoted, '"');
        if (unquoted.starts_with(words.back()))
            lines.push_back(fmt::format("{}\t{}\n", text, help.substr(0, help.find('\n'))));
    }
    std::sort(lines.begin(), lines.end());
    lines.erase(std::unique(lines.begin(), lines.end()), lines.end());
    return fmt::format("{}", fmt::join(lines, ""));
}

void add_completion(CLI::App& app) {
    auto shell = std::make_shared<std::string>();
    auto& command = *app.add_subcommand("completion", "A script by which a shell completes Doppel's words with TAB");
    command.footer(
        "Examples:\n"
        "  source <(doppel completion bash)    # in ~/.bashrc; zsh: the same in ~/.zshrc, after compinit\n"
        "  doppel completion fish > ~/.config/fish/completions/doppel.fish");
    command.add_option("SHELL", *shell, "bash, zsh or fish")->required()->check(CLI::IsMember({"bash", "zsh", "fish"}));
    command.callback([shell] {
        write_out(*shell == "bash" ? bash_script : *shell == "zsh" ? zsh_script : fish_script);
    });
}

}  // namespace doppel
