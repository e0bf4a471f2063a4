#include "base/error.hpp"
#include "cli/options.hpp"
#include "embedded/cli.hpp"
#include "film/pair_table.hpp"
#include "scene/preset_fields.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <sstream>
#include <string_view>
#include <tuple>

namespace doppel {
namespace {

namespace fs = std::filesystem;
using namespace std::string_view_literals;

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

/// find(preset) for the first of the words that is a readable preset.
template <class Find>
auto of_preset(const std::vector<std::string>& words, const Find& find) {
    for (std::size_t i = 1; i + 1 < words.size(); ++i) {
        if (words[i].starts_with('-') || words[i - 1].starts_with('-')) continue;
        try {
            return std::optional(find(find_preset(words[i])));
        } catch (const Error&) {
            continue;  // the value of an option, or an incomplete name
        }
    }
    return std::optional<decltype(find(PresetText()))>();
}

/// The kinds that --set may apply to: that of the given preset, or those that the command accepts.
std::vector<std::string> kinds_of(const std::string& command, const std::vector<std::string>& words) {
    if (const auto kind = of_preset(words, kind_of_preset)) return {*kind};
    if (command != "figure") return {std::string(pair_kind)};
    return {scene_kinds.begin() + 1, scene_kinds.end()};
}

/// The entries of a side with the name of this one, or without a name of its kind.
long count_like(SideSpec& side, const SideEntry& one) {
    return std::ranges::count_if(entries_of(side), [&](const SideEntry& entry) {
        return entry.table == one.table && (one.name.empty() ? entry.kind == one.kind : entry.name == one.name);
    });
}

/// The keys of a film's entries by their names, or by their kinds: "system.force.left.length_m=".
void add_entries(const std::vector<std::string>& words, const std::string& word, Candidates& all) {
    auto preset = of_preset(words, [](const PresetText& source) { return read_preset(source); });
    if (!preset) return;
    auto &a = preset->a, &b = preset->b;
    for (const auto& [table, side, other] : {std::tuple("system"sv, &a, &b), {"a"sv, &a, &b}, {"b"sv, &b, &a}})
        for_each_key(*side, [&, table = table, side = side, other = other](const SideEntry& of, const Field& field,
                                                                           const KeyMember& member) {
            const auto name = of.name.empty() ? of.kind : std::string_view(of.name);
            if (of.number == 0 || name == of.table || count_like(*side, of) != 1) return;
            const bool is_of_both = count_like(*other, of) == 1;
            if (table == "system" ? !is_of_both : of.name.empty() && is_of_both) return;
            const auto key = fmt::format("{}.{}.{}.{}=", table, of.table, name, field.key);
            all.push_back({word.starts_with(key) ? key + toml_value(member) : key, std::string(field.help)});
        });
}

/// The values of a key; in a list of names, 'video.panels=["energy","', those of its last one.
void add_key_values(const std::string& key, const std::vector<std::string>& values, const std::string& word,
                    Candidates& all) {
    for (const auto& value : values) all.push_back({key + value});
    if (word.substr(key.size(), 1) != "[") return;
    auto names = CLI::detail::split(word.substr(key.size() + 1), ',');
    for (const auto& value : values) {
        names.back() = value;
        for (const char* end : {"]", ","})
            if (!value.starts_with('['))
                all.push_back({fmt::format("{}[\"{}\"{}", key, fmt::join(names, "\",\""), end)});
    }
}

/// Whether the text begins with the word, which has lost its quotes.
bool begins_with(std::string text, const std::string& word) {
    std::erase(text, '"');
    return text.starts_with(word);
}

/// "table.key=", or the values of the key if it is complete. The list is made by tests/figure/starting_presets.cpp.
void add_settings(const std::string& command, const std::vector<std::string>& words, const std::string& word,
                  Candidates& all) {
    const auto kinds = kinds_of(command, words);
    add_entries(words, word, all);
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
        if (is_complete) add_key_values(key, {cells.begin() + 3, cells.end()}, word, all);
        is_axis |= is_complete && key.ends_with(".key=");
        if (key.starts_with("system.") || key.starts_with("a.") || key.starts_with("b."))
            of_sides.push_back({word_key + cells[1], cells[2]});
    }
    if (is_axis) all.insert(all.end(), of_sides.begin(), of_sides.end());
}

/// The last name of --columns: those of the given preset, if they are known without computation.
void add_columns(const std::vector<std::string>& words, const std::string& word, const std::string& option,
                 Candidates& all) {
    const auto columns = of_preset(words, [](const PresetText& source) {
        const auto preset = read_preset(source);
        if (preset.a.accuracy || preset.b.accuracy) throw bad_input("{}: takes its time", source.path);
        return columns_of(make_scene(preset));
    });
    const auto before = word.substr(0, std::max(option.size(), word.rfind(',') + 1));
    all.insert(all.end(), {{before + "a", "all of side a"}, {before + "b", "all of side b"}});
    for (const auto& column : columns.value_or(std::vector<std::string>())) all.push_back({before + column});
}

void add_values(const CLI::Option& option, const std::string& command, const std::vector<std::string>& words,
                const std::string& word, const std::string& before, Candidates& all) {
    if (option.get_name() == "--render") return add_presets("check", all);
    if (option.get_name() == "--set") return add_settings(command, words, word, all);
    if (option.get_name() == "--columns") return add_columns(words, word, before, all);
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
    for (const auto& [text, help] : candidates(app, words))
        if (begins_with(text, words.back()))
            lines.push_back(fmt::format("{}\t{}\n", text, help.substr(0, help.find('\n'))));
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
