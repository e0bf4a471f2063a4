#include "scene/manifest_json.hpp"

#include "output/output_file.hpp"
#include "output/sha256.hpp"
#include "scene/version.hpp"

#include <toml++/toml.h>

#include <algorithm>
#include <sstream>

namespace doppel {
namespace {

/// A file of the run, or every file of a folder.
void add_files(Json& files, const std::string& name, const std::filesystem::path& path) {
    if (!std::filesystem::is_directory(path)) {
        files[name] = {{"bytes", std::filesystem::file_size(path)}, {"sha256", sha256_of_file(path)}};
        return;
    }
    std::vector<std::filesystem::path> entries(std::filesystem::directory_iterator{path}, {});
    std::sort(entries.begin(), entries.end());
    for (const auto& entry : entries) add_files(files, name + "/" + entry.filename().string(), entry);
}

}  // namespace

Json json_of_toml(const std::string& toml) {
    std::ostringstream text;
    text << toml::json_formatter{toml::parse(toml)};
    return Json::parse(text.str());
}

Json program_json() {
    return {{"version", version()}, {"revision", revision()}};
}

Json files_json(const RunFiles& files) {
    Json json = Json::object();
    for (const auto& [name, where] : files) add_files(json, name, where);
    return json;
}

void write_json(const std::filesystem::path& path, const Json& json) {
    OutputFile file(path);
    file.write(json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
    file.close();
}

}  // namespace doppel
