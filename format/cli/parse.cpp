#include "parse.h"

#include "report.h"
#include "spelling/suggestion.h"

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

namespace drtv::cli {
namespace {

std::vector<std::string> commands_of(const CLI::App& app) {
    std::vector<std::string> names;
    for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
        names.push_back(command->get_name());
    return names;
}

// "--out" of each option that the app, or one that it stands in, takes.
std::vector<std::string> options_of(const CLI::App* app) {
    std::vector<std::string> names;
    for (; app != nullptr; app = app->get_parent()) {
        for (const CLI::Option* option : app->get_options()) {
            for (const std::string& name : option->get_lnames())
                names.push_back("--" + name);
        }
    }
    return names;
}

// A word that no command and no option takes; an option before an argument.
std::optional<std::string> unknown_word(const CLI::App& app) {
    std::vector<std::string> words = app.remaining();
    for (const CLI::App* command : app.get_subcommands()) {
        const std::vector<std::string> more = command->remaining();
        words.insert(words.end(), more.begin(), more.end());
    }
    const auto option =
        std::ranges::find_if(words, [](const std::string& word) { return word.starts_with("-"); });
    if (option != words.end())
        return *option;
    return words.empty() ? std::nullopt : std::optional(words.front());
}

std::string sentence_of(const CLI::App& app, const CLI::ParseError& error) {
    const auto chosen = app.get_subcommands();
    const CLI::App& command = chosen.empty() ? app : *chosen.front();
    const std::string name = chosen.empty() ? app.get_name() : app.get_name() + " " + command.get_name();
    const std::string prefix = chosen.empty() ? "" : command.get_name() + ": ";
    const std::string more = name + " --help says more";
    const std::optional<std::string> unknown = unknown_word(app);
    const bool lacks_command = chosen.empty() && dynamic_cast<const CLI::RequiredError*>(&error) != nullptr;
    if (!unknown && lacks_command)
        return spelling::with_hint("a command is required", "", more);
    if (!unknown)
        return spelling::with_hint(prefix + error.what(), "", more);
    if (unknown->starts_with("-")) {
        const std::string option = unknown->substr(0, unknown->find('='));
        return spelling::with_hint(prefix + "there is no option \"" + option + "\"",
                                   spelling::suggestion(option, options_of(&command)),
                                   more);
    }
    if (chosen.empty()) {
        return spelling::with_hint("there is no command \"" + *unknown + "\"",
                                   spelling::suggestion(*unknown, commands_of(app)),
                                   more);
    }
    return spelling::with_hint(prefix + "\"" + *unknown + "\" is one argument too many", "", more);
}

}  // namespace

std::optional<int> parse(CLI::App& app, int argc, const char* const* argv) {
    // What is wrong with the line is said in the way that the line asks for.
    report_as_json(
        std::any_of(argv, argv + argc, [](const char* word) { return std::string_view(word) == "--json"; }));
    try {
        app.parse(argc, argv);
        return std::nullopt;
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() != 0)
            return complain({exit_usage, sentence_of(app, error)});
        app.exit(error);  // --help, --version
        return end_program(exit_done);
    }
}

}  // namespace drtv::cli
