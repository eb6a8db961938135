#include "server/scenes/file_upload.h"

#include "import/apart/run_importer.h"

#include <utility>

namespace alvor {

namespace {

constexpr double largest_light_scale = 1e12;
constexpr std::size_t most_files = 10'000, most_luminaires = 10'000, most_translucent = 10'000;
/// What a file takes in memory besides its bytes.
constexpr std::uint64_t bytes_of_file = 200;

void check(const v1::ImportOptions& options) {
  if (options.has_light_scale() && !(options.light_scale() >= 0 && options.light_scale() <= largest_light_scale))
    throw invalid_field("options.light_scale", options.light_scale(), "is not in [0, 1e12]");
  refuse_beyond(static_cast<std::uint64_t>(options.absent_files_size()), most_files, "absent files");
  refuse_beyond(static_cast<std::uint64_t>(options.luminaires_size()), most_luminaires, "luminaires");
  refuse_beyond(static_cast<std::uint64_t>(options.translucent_size()), most_translucent, "translucent materials");
  const std::string& scene = options.scene_file();
  const std::string reason = reason_against_name(scene);
  if (!reason.empty()) throw invalid_argument("options.scene_file: '" + scene + "' " + reason);
  if (plain_name(scene) != scene || scene.find('/') != std::string::npos)
    throw invalid_argument("options.scene_file: '" + scene + "' has folders");
}

SceneUpload begun_scene(const UploadLimits& limits, const std::string& display_name) {
  SceneUpload scene(limits);
  v1::CreateSceneRequest first;
  first.mutable_scene()->set_display_name(display_name);
  scene.add(first);
  return scene;
}

}  // namespace

void FileUpload::begin(const v1::ImportSceneRequest& message) {
  if (!message.has_options()) throw invalid_argument("options: the first message must set them");
  check(message.options());
  options_ = message.options();
}

void FileUpload::add(const v1::ImportSceneRequest& message) {
  if (message.has_options()) throw invalid_argument("options: only the first message may set them");
  if (!message.has_piece()) throw invalid_argument("piece: is not set");
  add_piece(message.piece());
}

void FileUpload::add_piece(const v1::FilePiece& piece) {
  if (const std::string reason = reason_against_name(piece.file()); !reason.empty())
    throw invalid_argument("piece.file: '" + piece.file() + "' " + reason);
  const std::string name = plain_name(piece.file());
  const auto known = files_.find(name);
  if (known != files_.end() && piece.offset() != known->second.size()) {  // begun again, or with a gap
    bytes_ -= known->second.size() + bytes_of_file;
    files_.erase(known);
  }
  if (piece.offset() > 0 && !files_.contains(name)) return;  // a missing file from now on
  refuse_beyond(bytes_ + piece.content().size(), limits_.bytes, "bytes");
  limits_.memory.refuse_without_room("scene", piece.content().size());
  const auto [file, is_new] = files_.try_emplace(name);
  refuse_beyond(files_.size(), most_files, "files");
  file->second += piece.content();
  bytes_ += piece.content().size() + (is_new ? bytes_of_file : 0);
}

std::vector<std::string> FileUpload::read(SceneFiles& files, SceneUpload& scene, const CallStop& stop) const {
  const auto take = [&](v1::GeometryChunk& chunk) {
    v1::CreateSceneRequest message;
    message.mutable_chunk()->Swap(&chunk);
    scene.add(message);
  };
  try {
    const ImporterAnswer answer = run_importer(files, options_, take, limits_.importer, stop.token());
    if (!answer.missing.empty()) throw MissingFilesError(files.scene(), answer.missing);
    return answer.warnings;
  } catch (const ImportError& error) {
    stop.refuse_stopped();
    throw invalid_argument(files.scene() + ": " + error.what());
  }
}

std::shared_ptr<const StoredScene> FileUpload::finish(SceneStore& store, const Caller& caller, const CallStop& stop) {
  const std::string name = options_.scene_file();
  const auto main = files_.find(name);
  if (main == files_.end()) throw MissingFilesError(name, {name});
  limits_.memory.admit("scene", bytes_);
  stop.refuse_stopped();
  SceneFiles files(name, std::move(main->second));
  files_.erase(main);
  for (auto& [beside, bytes] : files_) files.add(beside, std::move(bytes));
  files_.clear();
  SceneUpload scene = begun_scene(limits_, options_.display_name());
  try {
    std::vector<std::string> warnings = read(files, scene, stop);
    files.release();
    return scene.finish(store, caller, stop, std::move(warnings));
  } catch (const MissingFilesError&) {
    files_ = files.release();
    throw;
  }
}

void FileUpload::describe(v1::Upload& upload) const {
  const auto tell = [&](const std::string& name, std::size_t bytes) {
    v1::UploadedFile& file = *upload.add_files();
    file.set_name(name);
    file.set_byte_count(bytes);
  };
  if (const auto main = files_.find(options_.scene_file()); main != files_.end()) tell(main->first, main->second.size());
  for (const auto& [name, bytes] : files_)
    if (name != options_.scene_file()) tell(name, bytes.size());
}

}  // namespace alvor
