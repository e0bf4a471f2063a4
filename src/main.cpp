#include "cli/commands.hpp"
#include "numeric/error.hpp"
#include "scene/nearest.hpp"
#include "scene/version.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <exception>

namespace {

/// A word in the place of the command that is none.
void refuse_unknown_command(const CLI::App& app, const std::string& word) {
    std::vector<std::string> names;
    for (const auto* command : app.get_subcommands({})) names.push_back(command->get_name());
    if (std::find(names.begin(), names.end(), word) != names.end()) return;
    const auto meant = doppel::nearest(word, std::vector<std::string_view>(names.begin(), names.end()));
    throw doppel::bad_input(
        "there is no command \"{}\"; {}", word,
        meant ? fmt::format("did you mean \"{}\"?", *meant) : fmt::format("there are {}", fmt::join(names, ", ")));
}

/// One line, whatever the message quotes; throws nothing where nobody reads it.
int failed(doppel::ExitCode code, std::string message) {
    std::replace_if(
        message.begin(), message.end(), [](unsigned char c) { return c < ' ' || c == 127; }, ' ');
    std::fprintf(stderr, "doppel: %s\n", message.c_str());
    return static_cast<int>(code);
}

}  // namespace

int main(int argc, char** argv) {
    using doppel::ExitCode;
    try {
        CLI::App app("Doppel films chaotic pendulums in pairs, a hair apart, and charts how they part.", "doppel");
        app.set_version_flag("--version", fmt::format("doppel {} ({})", doppel::version(), doppel::revision()));
        app.footer(
            "doppel COMMAND --help tells more. Exit codes: 0 done, 1 compare found a difference, 2 bad usage or "
            "input,\n"
            "3 the method failed, 4 reading, writing or encoding failed, 130 interrupted.");
        app.require_subcommand(1);

        int exit_code = 0;
        doppel::add_render(app);
        doppel::add_simulate(app);
        doppel::add_figure(app);
        doppel::add_compare(app, exit_code);
        doppel::add_list(app);
        doppel::add_show(app);
        doppel::add_check(app);
        if (argc > 1 && argv[1][0] != '-') refuse_unknown_command(app, argv[1]);
        try {
            app.parse(argc, argv);
        } catch (const CLI::ParseError& fault) {
            if (fault.get_exit_code() == 0) return app.exit(fault);
            return failed(ExitCode::bad_input, fmt::format("{}; see doppel --help", fault.what()));
        }
        return exit_code;
    } catch (const doppel::Error& fault) {
        return failed(fault.code(), fault.what());
    } catch (const std::bad_alloc&) {
        return failed(ExitCode::io_failed, "there is not enough memory");
    } catch (const std::exception& fault) {
        return failed(ExitCode::io_failed, fault.what());
    }
}
