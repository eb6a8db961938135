// seeds DIRECTORY FILES: writes the inputs with which fuzzing starts, a folder for each target: real messages, frames and
// checkpoints, and FILES.

#include "proto/codec.h"
#include "radiosity/solve/solver.h"
#include "server/archive/pieces.h"
#include "tests/fuzz/input.h"
#include "tests/import/environment_images.h"
#include "tests/import/texture_images.h"
#include "tests/scenes.h"

#include <filesystem>
#include <fstream>
#include <iterator>

namespace alvor {
namespace {

namespace fs = std::filesystem;

void write(const fs::path& path, const std::string& bytes) {
  fs::create_directories(path.parent_path());
  std::ofstream(path, std::ios::binary) << bytes;
}

std::string upload_of(const Scene& scene) {
  v1::CreateSceneRequest message;
  message.mutable_scene()->set_display_name("room");
  std::string bytes = std::string(1, '\0') + fuzz::as_text(message.SerializeAsString());
  SceneSlicer slicer(scene, 600);
  while (slicer.next(*message.mutable_chunk())) bytes += fuzz::as_text(message.SerializeAsString());
  return bytes;
}

/// Returns the messages that send a scene file and a part of it, in pieces.
std::string upload_of_files() {
  v1::ImportSceneRequest first;
  first.mutable_options()->set_scene_file("room.obj");
  first.mutable_options()->add_absent_files("wood.png");
  std::string bytes = '\1' + fuzz::as_text(first.SerializeAsString());
  const std::pair<const char*, std::string> files[]{{"room.obj", "mtllib a/b.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"},
                                                    {"a/b.mtl", "newmtl wood\nKd 1 1 1\n"}};
  for (const auto& [name, content] : files)
    for (std::size_t at = 0; at < content.size(); at += 16) {
      v1::ImportSceneRequest next;
      next.mutable_piece()->set_file(name);
      next.mutable_piece()->set_offset(at);
      next.mutable_piece()->set_content(content.substr(at, 16));
      bytes += fuzz::as_text(next.SerializeAsString());
    }
  return bytes;
}

std::string frames_of(const SolutionLog& log, Detail detail) {
  std::string bytes;
  for (Cursor cursor; cursor.base < log.head();) {
    const Delta delta = log.since(cursor, detail, 500);
    v1::WatchSolveResponse message;
    encode(delta, message);
    bytes += fuzz::as_text(message.SerializeAsString());
    cursor = delta.next;
  }
  return bytes;
}

std::string written(const SolveControl::Write& write) {
  const auto bytes = plain_bytes(write);
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// Returns the requests of one connection, each in two parts, from a browser that waits for the responses.
std::string connection_of(std::initializer_list<std::string> requests) {
  std::string bytes = "\1";
  for (const std::string& request : requests) {
    const std::size_t half = request.size() / 2;
    bytes += fuzz::as_text(request.substr(0, half)) + fuzz::as_text(request.substr(half));
  }
  return bytes;
}

void write_web_seeds(const fs::path& directory) {
  const std::string page = "GET / HTTP/1.1\r\nHost: localhost\r\nAccept-Encoding: gzip\r\n\r\n";
  const std::string call = " HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/grpc-web+proto\r\n";
  const std::string messages("\0\0\0\0\3abc\0\0\0\0\0", 13);
  const std::string with_length = "POST /a.B/Echo" + call + "Content-Length: 13\r\n\r\n" + messages;
  const std::string in_chunks = "POST /a.B/Echo" + call + "Transfer-Encoding: chunked\r\n\r\n6;x=y\r\n" + messages.substr(0, 6) +
                                "\r\n7\r\n" + messages.substr(6) + "\r\n0\r\nA: b\r\n\r\n";
  const std::string failing = "POST /a.B/Fail" + call + "Expect: 100-continue\r\nContent-Length: 13\r\n\r\n" + messages;
  const std::string preflight =
      "OPTIONS /a.B/Echo HTTP/1.1\r\nHost: localhost\r\nOrigin: https://room.example\r\nAccess-Control-Request-Method: "
      "POST\r\n\r\n";
  write(directory / "page", connection_of({page, page}));
  write(directory / "calls", connection_of({with_length, in_chunks, page}));
  write(directory / "failing", connection_of({failing, preflight, with_length}));
  write(directory / "old", connection_of({"POST /a.B/Echo HTTP/1.0\r\nContent-Type: application/grpc-web\r\n"
                                          "Content-Length: 13\r\n\r\n" +
                                          messages}));
}

void write_environment_seeds(const fs::path& directory) {
  const auto image =
      test::image_of(16, 8, [](int row, int column, int band) { return row == 2 && column == 3 ? 500 : 1 + band; });
  // The numbers of kinds are those of tests/fuzz/file_fuzz.cpp.
  write(directory / "10packed.hdr", "\x0a" + test::hdr_of(image));
  write(directory / "10flat.hdr", "\x0a" + test::hdr_of(image, false, "EXPOSURE=2\n"));
  for (const auto compression : {Imf::NO_COMPRESSION, Imf::RLE_COMPRESSION, Imf::ZIP_COMPRESSION, Imf::PIZ_COMPRESSION,
                                 Imf::PXR24_COMPRESSION, Imf::B44_COMPRESSION, Imf::DWAA_COMPRESSION})
    write(directory / ("11by" + std::to_string(compression) + ".exr"),
          "\x0b" + test::exr_of(image, {"R", "G", "B"}, compression));
}

/// An image's kind is that of a .png: what it is, its bytes tell.
void write_texture_seeds(const fs::path& directory) {
  const test::Texels texels{{188, 0, 0, 255}, {0, 188, 0, 0}, {9, 90, 200, 128}, {255, 255, 255, 1}};
  write(directory / "5lossless.webp", "\x05" + test::webp(2, texels));
  write(directory / "5lossy.webp", "\x05" + test::webp(2, texels, {.is_lossless = false}));
  write(directory / "5flat.webp", "\x05" + test::webp_of_one_colour(64, 64));
}

void write_edit_seeds(const fs::path& directory) {
  v1::EditStep step;
  v1::ObjectEdit& object = *step.add_edits()->mutable_object();
  object.set_name("block");
  object.mutable_move()->set_x(0.5);
  object.set_turn(30);
  object.mutable_turn_axis()->set_x(1);
  object.set_scale(0.5);
  step.add_edits()->mutable_object()->set_name("lamp");
  step.mutable_edits(1)->mutable_object()->set_hidden(true);
  step.add_edits()->mutable_material()->set_name("m0");
  step.mutable_edits(2)->mutable_material()->mutable_reflectance()->set_r(0.5);
  step.mutable_edits(2)->mutable_material()->mutable_regular_transmittance()->set_r(0.2);
  step.add_edits()->mutable_light()->set_name("bulb");
  step.mutable_edits(3)->mutable_light()->set_dim(0.5);
  step.add_edits()->mutable_copy()->set_name("second lamp");
  step.mutable_edits(4)->mutable_copy()->set_of("lamp");
  step.add_edits()->mutable_copy()->set_name("third lamp");
  step.mutable_edits(5)->mutable_copy()->set_scene("scenes/box");
  v1::EditStep undo;
  undo.set_kind(v1::EditStep::UNDO);
  const auto text = [](const v1::EditStep& of) { return '\0' + fuzz::as_text(of.SerializeAsString()); };
  write(directory / "edit" / "objects", text(step) + text(undo) + text(step));
}

void write_seeds(const fs::path& directory, std::span<char*> files) {
  write_edit_seeds(directory);
  const Scene room = test::coloured_room();
  write(directory / "scene_upload" / "room", upload_of(room));
  write(directory / "scene_upload" / "furnace", upload_of(test::furnace(1, 0.5)));
  write(directory / "scene_upload" / "files", upload_of_files());
  const BaseMesh mesh(room);
  SolutionLog log;
  SolveOptions options{.tolerance = 0.05, .max_leaves = 2000, .threads = 1};
  SolveControl control;
  int saves = 0;
  control.is_checkpoint_due = [] { return true; };
  control.save = [&](const SolveControl::Write& state) {
    write(directory / "checkpoint" / ("state" + std::to_string(saves)), "\x01" + written(state));
    write(directory / "checkpoint" / ("log" + std::to_string(saves++)),
          std::string(1, '\0') + written([&](PlainWriter& out) { log.save(out); }));
  };
  solve_as_planned(mesh, Plan(mesh, options), options, log, control);
  PieceWriter pieces;
  pieces.add(std::as_bytes(std::span(std::string_view("a piece, a piece, a piece"))));
  write(directory / "checkpoint" / "piece", "\x02" + pieces.finish().front());
  for (const Detail detail : {Detail::exact, Detail::display})
    write(directory / "frame" / (detail == Detail::exact ? "exact" : "display"), frames_of(log, detail));
  write(directory / "watch" / "ordinary", std::string("\1\3\7\0\1\3\5\0\1\3\5\1\0\2\3\5\1\6\0\x09\1\3", 22));
  write_web_seeds(directory / "web");
  write_environment_seeds(directory / "file");
  write_texture_seeds(directory / "file");
  const std::string kinds[] = {".obj", ".gltf",  ".glb", ".mtl", ".bin", ".png", "solution.glb",
                               ".ply", ".alvor", ".ies", ".ldt", ".hdr", ".exr"};
  for (char* file : files)
    for (std::size_t kind = 0; kind < std::size(kinds); ++kind) {
      if (!std::string_view(file).ends_with(kinds[kind])) continue;
      std::ifstream in(file, std::ios::binary);
      const std::string bytes((std::istreambuf_iterator<char>(in)), {});
      if (bytes.size() < 100'000)
        write(directory / "file" / (std::to_string(kind) + fs::path(file).filename().string()), char(kind) + bytes);
    }
}

}  // namespace
}  // namespace alvor

int main(int argc, char** argv) {
  if (argc < 2) return 2;
  alvor::write_seeds(argv[1], std::span(argv + 2, argv + argc));
}
