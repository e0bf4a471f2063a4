#include "figure/tile_folder.hpp"

#include "output/png.hpp"
#include "scene/resolved.hpp"

#include <chrono>
#include <fstream>
#include <iterator>
#include <thread>

namespace doppel {
namespace {

constexpr const char* mark_name = "pyramid.json";

std::string text_at(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

Folder claimed(const Folder& above, const std::string& name, const PartHeader& header) {
    if (above.entry(name).kind == Entry::Kind::none) above.make_folder(name);
    auto folder = above.folder(name);
    const Json mark{{"doppel", program_json()},
                    {"figure", header.figure},
                    {"preset_sha256", header.preset},
                    {"version", header.version},
                    {"revision", header.revision}};
    const auto text = mark.dump(2) + "\n";
    const FilePlace place(folder, mark_name);
    // another process, with another shard, may be writing it
    for (int tries = 0; tries < 40; ++tries) {
        if (folder.entry(mark_name).kind == Entry::Kind::none) {
            if (!folder.names().empty())
                throw io_failed("{} is not a folder of tiles of Doppel's; remove it, or give another folder with --out",
                                folder.path().string());
            OutputFile file(place);
            file.write(text);
            file.close();
        }
        const auto found = text_at(place.path);
        if (found == text) return folder;
        if (!text.starts_with(found)) break;
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
    throw io_failed("{} belongs to another preset or version; remove it, or give another folder with --out",
                    folder.path().string());
}

}  // namespace

TileFolder::TileFolder(const Folder& above, const std::string& name, const PartHeader& header)
    : folder_(claimed(above, name, header)) {
    for (const auto& tile : folder_.names())
        if (tile.ends_with(".png")) there_.insert(tile);
}

std::size_t TileFolder::count() const {
    const std::lock_guard hold(mutex_);
    return there_.size();
}

bool TileFolder::has(const std::string& tile) const {
    const std::lock_guard hold(mutex_);
    return there_.contains(tile);
}

Picture TileFolder::read(const std::string& tile) const {
    return read_png(folder_.path() / tile);
}

void TileFolder::write(const std::string& tile, const Picture& picture, const std::atomic<bool>& stop) {
    if (has(tile)) return;
    const FilePlace place(folder_, tile), part = part_of(place);
    if (folder_.entry(part.name).kind == Entry::Kind::file) folder_.remove(part.name);  // of a run that was killed
    write_png(part, picture, {.with_alpha = !picture.is_opaque()}, stop);
    rename_file(part, place);
    const std::lock_guard hold(mutex_);
    there_.insert(tile);
}

}  // namespace doppel
