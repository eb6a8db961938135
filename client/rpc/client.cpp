#include "client/rpc/client.h"

#include "google/rpc/status.pb.h"
#include "proto/codec.h"
#include "proto/status_name.h"

#include <algorithm>
#include <random>
#include <thread>

namespace alvor {

namespace {

std::string text_of(const grpc::Status& status) {
  std::string text = status.error_message();
  std::ranges::replace_if(
      text, [](unsigned char c) { return c < 0x20; }, ' ');
  return std::string(name_of(status.error_code())) + (text.empty() ? "" : ": " + text);
}

void check(const grpc::Status& status) {
  if (!status.ok()) throw RpcError(status);
}

/// A call context with a deadline of one minute, for calls that return at once.
struct Deadline : grpc::ClientContext {
  Deadline() { set_deadline(std::chrono::system_clock::now() + std::chrono::minutes(1)); }
};

/// Returns a random request id.
std::string random_id() {
  std::random_device source;
  std::string id;
  for (int n = 0; n < 4; ++n) id += std::to_string(source()) + (n < 3 ? "-" : "");
  return id;
}

/// Makes a call whose request is a name: call(context, request, response).
template <class Request, class Response, class Call>
Response by_name(const std::string& name, Call&& call) {
  Deadline deadline;
  grpc::ClientContext* const context = &deadline;
  Request request;
  request.set_name(name);
  Response response;
  Response* const into = &response;
  check(call(context, request, into));
  return response;
}

[[noreturn]] void refuse(const Fault& fault) { throw RpcError({grpc::DATA_LOSS, fault.text()}); }

// Reads all pages of a list: `call` fills in a response, `append` takes its items.
template <class Request, class Response, class Call, class Append>
void read_pages(Request request, Call&& call, Append&& append) {
  do {
    Deadline context;
    Response response;
    check(call(context, request, response));
    append(response);
    request.set_page_token(response.next_page_token());
  } while (!request.page_token().empty());
}

constexpr std::size_t piece_bytes = 1 << 20;

/// Writes the bytes of a file after the first `start` ones, at least one message. Returns false if the server does not take them.
bool write_pieces(grpc::ClientWriterInterface<v1::ImportSceneRequest>& writer, const std::string& name, const std::string& bytes,
                  std::uint64_t start) {
  std::uint64_t offset = start;
  do {
    v1::ImportSceneRequest request;
    v1::FilePiece& piece = *request.mutable_piece();
    piece.set_file(name);
    piece.set_offset(offset);
    piece.set_content(bytes.substr(offset, piece_bytes));
    offset += piece.content().size();
    if (!writer.Write(request)) return false;
  } while (offset < bytes.size());
  return true;
}

/// Adds those of the missing files that `find` returns, and names the others in the options. Returns false if all are known.
bool add_missing(std::map<std::string, std::string>& files, v1::ImportOptions& options, const std::vector<std::string>& missing,
                 const Client::FindFile& find) {
  bool is_any_new = false;
  for (const std::string& name : missing) {
    const bool is_absent = std::ranges::find(options.absent_files(), name) != options.absent_files().end();
    if (is_absent || files.contains(name)) continue;
    is_any_new = true;
    if (auto bytes = find(name)) files.emplace(name, *std::move(bytes));
    else options.add_absent_files(name);
  }
  return is_any_new;
}

std::vector<std::string> missing_files_of(const grpc::Status& status) {
  google::rpc::Status details;
  if (!details.ParseFromString(status.error_details())) return {};
  v1::MissingFiles missing;
  for (const google::protobuf::Any& detail : details.details())
    if (detail.UnpackTo(&missing)) return {missing.names().begin(), missing.names().end()};
  return {};
}

}  // namespace

RpcError::RpcError(const grpc::Status& status)
    : std::runtime_error(text_of(status)), code(status.error_code()), missing_files(missing_files_of(status)) {}

Client::Client(std::shared_ptr<grpc::Channel> channel, std::chrono::milliseconds patience)
    : channel_(std::move(channel)),
      patience_(patience),
      scenes_(v1::SceneService::NewStub(channel_)),
      solves_(v1::SolveService::NewStub(channel_)) {}

bool Client::wait_until_connected(std::chrono::milliseconds patience) const {
  return channel_->WaitForConnected(std::chrono::system_clock::now() + patience);
}

bool Client::Patience::wait() {
  constexpr std::chrono::milliseconds first_pause{50}, longest_pause{2000}, slice{100};
  const auto now = Clock::now();
  if (!failing_since_) {
    failing_since_ = now;
    pause_ = first_pause;
  }
  const auto end = *failing_since_ + client_.patience_, pause_end = std::min<Clock::time_point>(now + pause_, end);
  pause_ = std::min(2 * pause_, longest_pause);
  while (!stop_.stop_requested() && Clock::now() < pause_end) std::this_thread::sleep_for(first_pause);
  while (!stop_.stop_requested() && Clock::now() < end)
    if (client_.wait_until_connected(slice)) return true;
  return false;
}

v1::Scene Client::create_scene(const Scene& scene, const std::string& display_name) {
  v1::CreateSceneRequest first;
  first.mutable_scene()->set_display_name(as_utf8(display_name));
  first.set_request_id(random_id());
  bool has_begun = false;
  return with_patience([&](Patience& patience) {
    if (has_begun) {
      const std::uint64_t chunks = received(first.request_id()).chunk_count();
      if (chunks > first.resume_after_chunks()) patience.note_success();
      first.set_resume_after_chunks(chunks);
    }
    has_begun = true;
    return upload(first, scene);
  });
}

v1::Scene Client::upload(const v1::CreateSceneRequest& first, const Scene& scene) {
  grpc::ClientContext context;
  v1::Scene stored;
  const auto writer = scenes_->CreateScene(&context, &stored);
  SceneSlicer slicer(scene);
  v1::CreateSceneRequest request;
  for (std::uint64_t sent = 0; sent < first.resume_after_chunks(); ++sent) slicer.next(*request.mutable_chunk());
  request = first;
  // A write fails if the server has refused what came before; Finish then returns the reason.
  while (writer->Write(request)) {
    request.Clear();
    if (!slicer.next(*request.mutable_chunk())) break;
  }
  writer->WritesDone();
  check(writer->Finish());
  return stored;
}

v1::Scene Client::import_scene(v1::ImportOptions options, std::string bytes, const FindFile& find) {
  v1::ImportSceneRequest first;
  first.set_request_id(random_id());
  std::map<std::string, std::string> files;
  files.emplace(options.scene_file(), std::move(bytes));
  bool has_begun = false, has_repeated = false;
  for (;;) {
    *first.mutable_options() = options;
    try {
      return with_patience([&] {
        const v1::Upload known = has_begun ? received(first.request_id()) : v1::Upload();
        has_begun = true;
        return upload(first, files, known);
      });
    } catch (const RpcError& error) {
      // The server may have dropped what it had; then all is sent once more.
      const bool is_news = add_missing(files, options, error.missing_files, find);
      if (!is_news && (error.missing_files.empty() || has_repeated)) throw;
      has_repeated = !is_news;
    }
  }
}

v1::Scene Client::upload(const v1::ImportSceneRequest& first, const std::map<std::string, std::string>& files,
                         const v1::Upload& known) {
  std::map<std::string, std::uint64_t> sizes;
  for (const v1::UploadedFile& file : known.files()) sizes.emplace(file.name(), file.byte_count());
  grpc::ClientContext context;
  v1::Scene stored;
  const auto writer = scenes_->ImportScene(&context, &stored);
  // A write fails if the server has refused what came before; Finish then returns the reason.
  bool is_taken = writer->Write(first);
  for (const auto& [name, bytes] : files) {
    const auto found = sizes.find(name);
    if (found != sizes.end() && found->second == bytes.size()) continue;
    const std::uint64_t start = found != sizes.end() && found->second < bytes.size() ? found->second : 0;
    is_taken = is_taken && write_pieces(*writer, name, bytes, start);
  }
  writer->WritesDone();
  check(writer->Finish());
  return stored;
}

v1::Upload Client::received(const std::string& request_id) {
  v1::GetUploadRequest request;
  request.set_request_id(request_id);
  v1::Upload upload;
  Deadline context;
  const grpc::Status status = scenes_->GetUpload(&context, request, &upload);
  if (!status.ok() && status.error_code() != grpc::NOT_FOUND) throw RpcError(status);
  return upload;
}

v1::Scene Client::get_scene(const std::string& name) {
  return by_name<v1::GetSceneRequest, v1::Scene>(name, [this](auto&... call) { return scenes_->GetScene(call...); });
}

std::vector<v1::Scene> Client::list_scenes() {
  std::vector<v1::Scene> all;
  read_pages<v1::ListScenesRequest, v1::ListScenesResponse>(
      {}, [&](auto& context, auto& request, auto& response) { return scenes_->ListScenes(&context, request, &response); },
      [&](const auto& response) { all.insert(all.end(), response.scenes().begin(), response.scenes().end()); });
  return all;
}

void Client::delete_scene(const std::string& name) {
  by_name<v1::DeleteSceneRequest, google::protobuf::Empty>(name, [this](auto&... call) { return scenes_->DeleteScene(call...); });
}

Scene Client::read_scene(const std::string& name, std::optional<std::uint64_t> edits) {
  grpc::ClientContext context;
  v1::ReadSceneRequest request;
  request.set_name(name);
  if (edits) request.set_edits(*edits);
  const auto reader = scenes_->ReadScene(&context, request);
  SceneAssembler assembler;
  std::optional<Fault> fault;
  for (v1::ReadSceneResponse response; !fault && reader->Read(&response);) fault = assembler.add(response.chunk());
  if (fault) {
    context.TryCancel();
    refuse(*fault);
  }
  check(reader->Finish());
  return assembler.take();
}

v1::Solve Client::create_solve(const std::string& scene_name, const v1::SolveSpec& spec) {
  v1::CreateSolveRequest request;
  request.set_parent(scene_name);
  *request.mutable_solve()->mutable_spec() = spec;
  request.set_request_id(random_id());
  return with_patience([&] {
    Deadline context;
    v1::Solve solve;
    check(solves_->CreateSolve(&context, request, &solve));
    return solve;
  });
}

v1::Solve Client::get_solve(const std::string& name) {
  return by_name<v1::GetSolveRequest, v1::Solve>(name, [this](auto&... call) { return solves_->GetSolve(call...); });
}

std::vector<v1::Solve> Client::list_solves(const std::string& parent) {
  v1::ListSolvesRequest first;
  first.set_parent(parent);
  std::vector<v1::Solve> all;
  read_pages<v1::ListSolvesRequest, v1::ListSolvesResponse>(
      first, [&](auto& context, auto& request, auto& response) { return solves_->ListSolves(&context, request, &response); },
      [&](const auto& response) { all.insert(all.end(), response.solves().begin(), response.solves().end()); });
  return all;
}

v1::Solve Client::cancel_solve(const std::string& name) {
  return by_name<v1::CancelSolveRequest, v1::Solve>(name, [this](auto&... call) { return solves_->CancelSolve(call...); });
}

v1::Solve Client::pause_solve(const std::string& name) {
  return by_name<v1::PauseSolveRequest, v1::Solve>(name, [this](auto&... call) { return solves_->PauseSolve(call...); });
}

v1::Solve Client::resume_solve(const std::string& name) {
  return by_name<v1::ResumeSolveRequest, v1::Solve>(name, [this](auto&... call) { return solves_->ResumeSolve(call...); });
}

v1::EditSolveResponse Client::edit_solve(const std::string& name, const v1::EditStep& step,
                                         std::optional<std::uint64_t> base_revision) {
  v1::EditSolveRequest request;
  request.set_name(name);
  *request.mutable_step() = step;
  request.set_request_id(random_id());
  if (base_revision) request.set_base_revision(*base_revision);
  return with_patience([&] {
    Deadline context;
    v1::EditSolveResponse response;
    check(solves_->EditSolve(&context, request, &response));
    return response;
  });
}

void Client::delete_solve(const std::string& name) {
  by_name<v1::DeleteSolveRequest, google::protobuf::Empty>(name, [this](auto&... call) { return solves_->DeleteSolve(call...); });
}

}  // namespace alvor
