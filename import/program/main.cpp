// The main program of alvor-import: reads the files of one scene from stdin and writes the scene to stdout, both as records
// (import/apart/records.h). Other programs start it; it is of no use by itself.

#include "import/base/import_error.h"
#include "import/formats/import_scene.h"
#include "import/program/sandbox.h"
#include "import/program/standard_stream.h"
#include "proto/codec.h"

#include <unistd.h>

#include <cstdlib>
#include <exception>
#include <iostream>
#include <new>
#include <optional>
#include <utility>

namespace alvor {

namespace {

constexpr std::size_t chunk_bytes = 1 << 24;

struct Request {
  v1::ImportOptions options;
  std::optional<SceneFiles> files;
};

void add_file(Request& request, std::string name, std::string bytes) {
  if (name.empty()) return;
  if (!request.files) request.files.emplace(std::move(name), std::move(bytes));
  else request.files->add(name, std::move(bytes));
}

/// Reads records up to the end of the request. Returns a request without files if the sender broke off.
Request read_request(RecordStream& stream) {
  Request request;
  std::string name, bytes;
  while (auto record = stream.read()) switch (record->kind) {
      case RecordKind::options:
        if (!request.options.ParseFromString(record->bytes)) return {};
        break;
      case RecordKind::file:
        add_file(request, std::move(name), std::move(bytes));
        name = std::move(record->bytes);
        bytes.clear();
        break;
      case RecordKind::piece: bytes += record->bytes; break;
      case RecordKind::end: add_file(request, std::move(name), std::move(bytes)); return request;
      default: return {};
    }
  return {};
}

void answer(RecordStream& stream, const ImportedScene& imported) {
  for (const std::string& name : imported.missing) stream.write(RecordKind::missing, name);
  if (imported.missing.empty()) {
    SceneSlicer slicer(imported.file.scene, chunk_bytes);
    v1::GeometryChunk chunk;
    while (slicer.next(chunk))
      if (!stream.write(RecordKind::chunk, chunk.SerializeAsString())) return;
  }
  for (const std::string& warning : imported.file.warnings) stream.write(RecordKind::warning, warning);
  stream.write(RecordKind::end, {});
}

void run(RecordStream& stream) {
  try {
    Request request = read_request(stream);
    if (request.files) answer(stream, import_scene(*request.files, request.options));
  } catch (const ImportError& error) {
    stream.write(RecordKind::error, error.what());
  } catch (const std::bad_alloc&) {
    stream.write(RecordKind::error, "file: needs too much memory");
  }
}

int start(int argc, char** argv) {
  if (argc != 3) {
    std::cerr << "alvor-import reads scenes for alvor and alvord; it is started by them\n";
    return 2;
  }
  try {
    enter_sandbox({.memory_bytes = std::strtoull(argv[1], nullptr, 10), .cpu_seconds = std::strtoull(argv[2], nullptr, 10)});
  } catch (const std::exception& error) {
    std::cerr << "alvor-import: " << error.what() << '\n';
    return exit_unrestricted;
  }
  StandardStream stream;
  run(stream);
  return 0;
}

}  // namespace

}  // namespace alvor

int main(int argc, char** argv) { _exit(alvor::start(argc, argv)); }  // destructors and LeakSanitizer want more rights
