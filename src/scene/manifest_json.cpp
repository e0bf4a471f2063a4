#include "scene/manifest_json.hpp"

#include "base/embedded.hpp"
#include "output/folder.hpp"
#include "output/written.hpp"

#include <toml++/toml.h>

#include <sstream>

namespace doppel {
namespace {

Json file_json(std::uintmax_t bytes, const std::string& sha256) {
    return {{"bytes", bytes}, {"sha256", sha256}};
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

void write_manifest(Transaction& parts, const std::string& name, Json manifest) {
    const auto place = parts.file(name);
    auto& files = manifest["files"] = Json::object();
    for (const auto& [file, where] : parts.finished_files())
        files[file] = file_json(where.folder->entry(where.name).bytes, sha256_of_file(where));
    for (const auto& [file, about] : parts.earlier_files())
        if (file != name) manifest["earlier_files"][file] = file_json(about.bytes, about.sha256);
    OutputFile output(place);
    output.write(manifest.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
    output.close();
    parts.finished(name);
}

}  // namespace doppel
