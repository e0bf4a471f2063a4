#include "base/embedded.hpp"
#include "base/error.hpp"
#include "cli/options.hpp"
#include "cli/program.hpp"
#include "cli/terminal.hpp"
#include "figure/preset.hpp"
#include "output/transaction.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <memory>
#include <sstream>

namespace doppel {
namespace {

constexpr std::string_view of_presets = "doppel.toml";

constexpr std::string_view exit_codes = R"(.SH EXIT STATUS
.TP
.B 0
Done.
.TP
.B 1
.B compare
found a difference.
.TP
.B 2
Bad usage or input.
.TP
.B 3
The method failed.
.TP
.B 4
Reading, writing or encoding failed.
.TP
.B 130
Interrupted.
)";

constexpr std::string_view files = R"(.SH FILES
.TP
.I out/NAME/
The results of the preset NAME: film or picture, CSV, and the manifest
.IR NAME.json .
.TP
.IR presets/ ", " presets/figures/
Where a preset is looked for by its name; others are built in.
.TP
.I /usr/share/doppel/presets/preset.schema.json
The schema of presets, where the package installed it.
)";

constexpr std::string_view preset_introduction = R"(.SH DESCRIPTION
A preset is a TOML file that describes two pendulums and the film of them, or a figure.
Every key has a default; units are part of the key.
A key that is not listed here is an error.
.PP
Side a has the keys of
.B [system]
with those of
.B [a]
in their place, side b those of
.BR [b] .
Arrays with one number a link may also be one number for all links.
.PP
.B kind
of
.B [scene]
says whether it is a film
.RB ( \(dqpair\(dq )
or which figure.
Figures have
.B [chart]
and a table of their own in place of
.BR [video] .
.SH EXAMPLE
.nf
title = \(dqThree thousandths of a degree\(dq

[scene]
duration_s = 30

[system]                  # both sides
angle_deg = [90, 90]

[b]                       # the second side, where it differs
angle_deg = [90.003, 90]
.fi
)";

/// A line of roff that shows the text, on one line, and obeys nothing in it.
std::string roff(std::string_view text) {
    std::string line;
    for (const char c : text) {
        switch (c) {
            case '\\':
                line += "\\e";
                break;
            case '-':
                line += "\\-";
                break;
            case '"':
                line += "\\(dq";
                break;
            case '\'':
                line += "\\(aq";
                break;
            case '^':
                line += "\\(ha";
                break;
            case '~':
                line += "\\(ti";
                break;
            case '\n':
                line += ' ';
                break;
            default:
                line += c;
        }
    }
    return line.starts_with('.') ? "\\&" + line : line;
}

std::string bold(std::string_view text) {
    return fmt::format("\\fB{}\\fR", roff(text));
}

std::string italic(std::string_view text) {
    return fmt::format("\\fI{}\\fR", roff(text));
}

std::string upper(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::toupper(c); });
    return text;
}

std::string title(const std::string& name, int section, std::string_view what) {
    return fmt::format(".TH {} {} \"\" \"Doppel {}\" \"Doppel\"\n.SH NAME\n{} \\- {}\n", upper(name), section,
                       version(), roff(name), roff(what));
}

std::string page_name(const CLI::App& command) {
    return command.get_parent() ? fmt::format("doppel-{}", command.get_name()) : "doppel";
}

/// "A:B", or "N" of "N:INT in [1 - 1024]", which tells of a check; empty of a flag.
std::string value_name(const CLI::Option& option) {
    if (option.get_items_expected_max() == 0) return "";
    const auto name = option.get_type_name();
    const auto range = name.find(" in [");
    return name.substr(0, range != std::string::npos ? name.rfind(':', range) : name.find(":{"));
}

std::string synopsis(const CLI::App& command) {
    auto text = fmt::format(".SH SYNOPSIS\n{} [{}]",
                            bold(command.get_parent() ? "doppel " + command.get_name() : "doppel"), italic("OPTIONS"));
    if (!command.get_parent()) text += fmt::format(" {} ...", italic("COMMAND"));
    for (const auto* option : command.get_options()) {
        if (!option->get_positional()) continue;
        const auto several = option->get_items_expected_max() > 1 ? " ..." : "";
        const auto word = italic(option->get_name()) + several;
        text += option->get_required() ? " " + word : fmt::format(" [{}]", word);
    }
    return text + "\n";
}

std::string options(const CLI::App& command) {
    std::string text = ".SH OPTIONS\n";
    for (const auto* option : command.get_options()) {
        std::vector<std::string> names;
        for (const auto& name : option->get_snames()) names.push_back(bold("-" + name));
        for (const auto& name : option->get_lnames()) names.push_back(bold("--" + name));
        if (option->get_positional()) names = {italic(option->get_name())};
        const auto value = option->get_positional() ? "" : value_name(*option);
        text += fmt::format(".TP\n{}{}\n{}", fmt::join(names, ", "), value.empty() ? "" : " " + italic(value),
                            roff(option->get_description()));
        if (const auto usual = option->get_default_str(); !usual.empty())
            text += fmt::format(" (default: {})", roff(usual));
        text += ".\n";
    }
    return text;
}

/// The footer of the help: "Examples:", lines that are indented, and sentences.
std::string examples(const CLI::App& command) {
    std::istringstream lines(command.get_footer());
    std::string shown, said;
    for (std::string line; std::getline(lines, line);)
        if (line.starts_with("  "))
            shown += roff(line.substr(2)) + "\n";
        else if (!line.starts_with("Example"))
            said += roff(line) + "\n";
    if (shown.empty()) return "";
    return fmt::format(".SH EXAMPLES\n.nf\n{}.fi\n{}{}", shown, said.empty() ? "" : ".PP\n", said);
}

std::string see_also(const std::vector<std::string>& pages) {
    std::vector<std::string> names;
    for (const auto& page : pages) names.push_back(fmt::format("{}({})", bold(page), page == of_presets ? 5 : 1));
    return fmt::format(".SH SEE ALSO\n{}\n", fmt::join(names, ",\n"));
}

/// doppel(1), or doppel-COMMAND(1).
std::string page_of(const CLI::App& command) {
    auto page = title(page_name(command), 1, command.get_description()) + synopsis(command);
    std::vector<std::string> others{std::string(of_presets)};
    if (const auto* app = command.get_parent()) {
        page += fmt::format(".SH DESCRIPTION\n{}.\n", roff(command.get_description()));
        others.push_back("doppel");
        for (const auto* other : app->get_subcommands([](const CLI::App*) { return true; }))
            if (other != &command) others.push_back(page_name(*other));
    } else {
        page +=
            fmt::format(".SH DESCRIPTION\n{}\nEach command has a page of its own.\n", roff(command.get_description()));
        for (const auto* each : command.get_subcommands([](const CLI::App*) { return true; })) {
            page += fmt::format(".TP\n{}\n{}.\n", bold(each->get_name()), roff(each->get_description()));
            others.push_back(page_name(*each));
        }
    }
    return page + options(command) + examples(command) + std::string(exit_codes) + std::string(files) +
           see_also(others);
}

std::string keys(const FieldTable& table) {
    auto text = fmt::format(".SS {}\n", roff(table.name));
    if (!table.text.empty()) text += roff(plain_words(table.text)) + "\n";
    for (const auto& field : table.fields) {
        text += fmt::format(".TP\n{}\n{}.\nTakes: {}.\n", bold(field.key), roff(plain_words(std::string(field.help))),
                            roff(plain_words(field.takes())));
        if (!field.unit.empty()) text += fmt::format("Unit: {}.\n", roff(field.unit));
        text +=
            field.is_needed() ? "Must be given.\n" : fmt::format("Default: {}.\n", roff(plain_words(field.by_default)));
    }
    for (const auto& inner : table.tables) text += keys(inner);
    return text;
}

/// doppel.toml(5)
std::string page_of_presets() {
    auto page = title(std::string(of_presets), 5, "presets of doppel(1): films of pendulums, and figures");
    page += preset_introduction;
    page += ".SH KEYS OF FILMS\n";
    for (const auto& table : film_tables()) page += keys(table);
    page += ".SH KEYS OF FIGURES\n";
    for (const auto& table : figure_tables()) page += keys(table);
    return page + see_also({"doppel", "doppel-check", "doppel-init", "doppel-schema", "doppel-show"});
}

/// Pages, each with the file that it goes into.
using Pages = std::vector<std::pair<std::string, std::string>>;

/// All or none, in place of older pages alone.
void write_pages(const std::filesystem::path& folder, const Pages& pages) {
    Transaction parts(folder, "man", "manual");
    for (const auto& [name, page] : pages) parts.demand(name);
    for (const auto& [name, page] : pages) {
        OutputFile file(parts.file(name));
        file.write(page);
        file.close();
    }
    parts.publish();
}

Pages all_pages(const CLI::App& app) {
    Pages pages{{"doppel.1", page_of(app)}};
    for (const auto* command : app.get_subcommands([](const CLI::App*) { return true; }))
        pages.emplace_back(page_name(*command) + ".1", page_of(*command));
    pages.emplace_back(fmt::format("{}.5", of_presets), page_of_presets());
    return pages;
}

}  // namespace

void add_man(CLI::App& app) {
    auto name = std::make_shared<std::string>(), folder = std::make_shared<std::string>();
    auto& command = *app.add_subcommand("man", "The manual page of a command, of presets, or of the program");
    command.footer(
        "Examples:\n"
        "  doppel man render | man -l -\n"
        "  doppel man doppel.toml | man -l -    # all keys of presets\n"
        "  doppel man --all man                 # man/doppel.1, man/doppel-render.1 ... man/doppel.toml.5");
    std::vector<std::string> names{std::string(of_presets)};
    for (const auto* each : app.get_subcommands([](const CLI::App*) { return true; }))
        names.push_back(each->get_name());
    command.add_option("PAGE", *name, "A command, or doppel.toml: presets; the program where not given")
        ->check(CLI::IsMember(names));
    refuse_dash(command.add_option("--all", *folder, "Write all pages into this folder"))->type_name("DIR");
    command.callback([name, folder, &app] {
        if (!name->empty() && !folder->empty()) throw bad_input("--all writes every page; leave {} out", *name);
        const auto wanted = name->empty()         ? "doppel.1"
                            : *name == of_presets ? "doppel.toml.5"
                                                  : "doppel-" + *name + ".1";
        const auto pages = all_pages(app);
        if (!folder->empty()) return write_pages(*folder, pages);
        for (const auto& [file, page] : pages)
            if (file == wanted) write_out(page);
    });
}

}  // namespace doppel
