// Tests ImportScene: what is sent when, and what becomes of scenes whose reader has a fault.

#include "client/rpc/client.h"
#include "google/rpc/status.pb.h"
#include "tests/server/sample_scenes.h"
#include "tests/server/test_server.h"

#include <gtest/gtest.h>

#include <map>
#include <string>
#include <vector>

namespace alvor {
namespace {

using Names = std::vector<std::string>;

const std::string triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl lamp\nf 1 2 3\n";
const std::string room_text = "mtllib a.mtl b.mtl\n" + triangle;
const std::string lamp = "newmtl lamp\nKd .5 .5 .5\nKe 1 1 1\n";

v1::ImportSceneRequest beginning(const std::string& file, const std::string& request_id = "") {
  v1::ImportSceneRequest request;
  request.mutable_options()->set_scene_file(file);
  request.mutable_options()->set_display_name("room");
  request.set_request_id(request_id);
  return request;
}

v1::ImportSceneRequest piece(const std::string& file, const std::string& content, std::uint64_t offset = 0) {
  v1::ImportSceneRequest request;
  request.mutable_piece()->set_file(file);
  request.mutable_piece()->set_offset(offset);
  request.mutable_piece()->set_content(content);
  return request;
}

/// A server and calls to it.
class ImportScene : public testing::Test {
 protected:
  static ServiceOptions with_importer(const ImporterOptions& importer) {
    ServiceOptions options;
    options.upload.importer = importer;
    return options;
  }
  void restart(ServiceOptions options) {
    stub_.reset();
    server_.emplace(std::move(options));
    stub_ = v1::SceneService::NewStub(server_->channel());
  }
  void SetUp() override { restart({}); }

  grpc::Status send(const std::vector<v1::ImportSceneRequest>& messages) {
    grpc::ClientContext context;
    scene_.Clear();
    const auto writer = stub_->ImportScene(&context, &scene_);
    for (const v1::ImportSceneRequest& message : messages)
      if (!writer->Write(message)) break;
    writer->WritesDone();
    return writer->Finish();
  }
  std::string refusal(const std::vector<v1::ImportSceneRequest>& messages) {
    const grpc::Status status = send(messages);
    return status.ok() ? "accepted" : std::to_string(status.error_code()) + " " + status.error_message();
  }
  Names missing(const std::vector<v1::ImportSceneRequest>& messages) { return RpcError(send(messages)).missing_files; }

  Names waiting(const std::string& request_id) {
    grpc::ClientContext context;
    v1::GetUploadRequest request;
    request.set_request_id(request_id);
    v1::Upload upload;
    Names names;
    if (!stub_->GetUpload(&context, request, &upload).ok()) return names;
    for (const v1::UploadedFile& file : upload.files()) names.push_back(file.name() + " " + std::to_string(file.byte_count()));
    return names;
  }

  std::optional<TestServer> server_;
  std::unique_ptr<v1::SceneService::Stub> stub_;
  v1::Scene scene_;  ///< the newest answer
};

TEST_F(ImportScene, AnswersWithTheSceneAndItsWarnings) {
  ASSERT_TRUE(send({beginning("room.stl.obj"), piece("room.stl.obj", triangle)}).ok());
  EXPECT_EQ(scene_.display_name(), "room");
  EXPECT_EQ(scene_.face_count(), 1u);
  ASSERT_GE(scene_.warnings_size(), 1);
  EXPECT_EQ(scene_.warnings(0), "material 'lamp' is in no material library: grey, reflectance 0.5");
}

TEST_F(ImportScene, ListsAllMissingFilesAndGoesOnWithThemAlone) {
  EXPECT_EQ(missing({beginning("room.obj", "id"), piece("room.obj", room_text)}), (Names{"a.mtl", "b.mtl"}));
  EXPECT_EQ(waiting("id"), Names{"room.obj " + std::to_string(room_text.size())});
  EXPECT_EQ(missing({beginning("room.obj", "id"), piece("b.mtl", "")}), Names{"a.mtl"});
  ASSERT_TRUE(send({beginning("room.obj", "id"), piece("a.mtl", lamp)}).ok());
  EXPECT_EQ(scene_.warnings_size(), 0) << scene_.warnings(0);
  EXPECT_EQ(waiting("id"), Names{}) << "nothing waits any more";
}

TEST_F(ImportScene, ForgetsTheFilesOfCallsWithoutAnId) {
  EXPECT_EQ(missing({beginning("room.obj"), piece("room.obj", room_text)}), (Names{"a.mtl", "b.mtl"}));
  EXPECT_EQ(missing({beginning("room.obj"), piece("a.mtl", lamp)}), Names{"room.obj"});
}

TEST_F(ImportScene, DoesWithoutMissingFilesOnDemand) {
  v1::ImportSceneRequest first = beginning("room.obj");
  for (const char* name : {"a.mtl", "b.mtl"}) first.mutable_options()->add_absent_files(name);
  ASSERT_TRUE(send({first, piece("room.obj", room_text)}).ok());
  EXPECT_EQ(scene_.warnings(0), "material library 'a.mtl' cannot be read");
}

TEST_F(ImportScene, TakesFilesInPiecesAndRefusesGaps) {
  const auto half = room_text.size() / 2;
  const auto pieces = [&](std::size_t offset) {
    return std::vector{beginning("room.obj"), piece("b.mtl", ""), piece("./a.mtl", lamp),
                       piece("room.obj", room_text.substr(0, half)), piece("room.obj", room_text.substr(half), offset)};
  };
  EXPECT_TRUE(send(pieces(half)).ok());
  EXPECT_EQ(missing(pieces(half + 1)), Names{"room.obj"});
}

TEST_F(ImportScene, ARepeatedRequestReturnsTheFirstScene) {
  const std::vector messages{beginning("room.obj", "once"), piece("room.obj", triangle)};
  ASSERT_TRUE(send(messages).ok());
  const std::string name = scene_.name();
  ASSERT_TRUE(send(messages).ok());
  EXPECT_EQ(scene_.name(), name);
}

TEST_F(ImportScene, RefusesWhatCannotBeMeant) {
  EXPECT_EQ(refusal({}), "3 request: has no messages");
  EXPECT_EQ(refusal({piece("room.obj", room_text)}), "3 options: the first message must set them");
  EXPECT_EQ(refusal({beginning("room.obj"), beginning("room.obj")}), "3 options: only the first message may set them");
  EXPECT_EQ(refusal({beginning("a/room.obj")}), "3 options.scene_file: 'a/room.obj' has folders");
  EXPECT_EQ(refusal({beginning("")}), "3 options.scene_file: '' names no file");
  EXPECT_EQ(refusal({beginning("room.obj"), piece("../a.mtl", lamp)}), "3 piece.file: '../a.mtl' leaves the folder of the scene");
  v1::ImportSceneRequest first = beginning("room.obj");
  first.mutable_options()->set_light_scale(-1);
  EXPECT_EQ(refusal({first}), "3 options.light_scale: -1 is not in [0, 1e12]");
}

TEST_F(ImportScene, NamesTheFileThePlaceAndTheReason) {
  EXPECT_EQ(refusal({beginning("room.obj"), piece("room.obj", "v 0 0\n")}), "3 room.obj: line 1: 'v' needs three numbers");
  EXPECT_EQ(refusal({beginning("room.glb"), piece("room.glb", "glTF")}), "3 room.glb: file: ends within its header");
  EXPECT_EQ(refusal({beginning("room.obj"), piece("room.obj", "")}), "3 room.obj: file: is empty");
}

TEST_F(ImportScene, EndsAtTheLimits) {
  ServiceOptions options;
  options.upload.bytes = 2000;
  restart(options);
  EXPECT_EQ(refusal({beginning("room.obj"), piece("room.obj", std::string(3000, ' '))}),
            "8 scene: more than 2000 bytes, the limit of this server");
  options.upload = {};
  options.upload.corners = 2;
  restart(options);
  EXPECT_EQ(refusal({beginning("room.obj"), piece("room.obj", triangle)}),
            "8 scene: more than 2 corners, the limit of this server");
}

const ImporterOptions faulty{
    .program = ALVOR_BINARIES "/faulty_importer", .memory_bytes = 512 << 20, .patience = std::chrono::milliseconds(200)};

TEST_F(ImportScene, AFaultyReaderIsAFaultOfTheFileAndTheServerGoesOn) {
  restart(with_importer(faulty));
  Client client(server_->channel());
  const std::string reader = "3 room.fbx: file: the library that reads this format ";
  const std::map<std::string, std::string> faults{{"crash", reader + "crashed (Segmentation fault)"},
                                                  {"abort", reader + "crashed (Aborted)"},
                                                  {"hang", reader + "did not come to an end"},
                                                  {"write without end", reader + "did not come to an end"},
                                                  {"speak nonsense", reader + "answered nonsense"},
                                                  {"open", reader + "was ended: it tried what reading a scene does not need"},
                                                  {"socket", reader + "was ended: it tried what reading a scene does not need"}};
  for (const auto& [fault, text] : faults) {
    EXPECT_EQ(refusal({beginning("room.fbx"), piece("room.fbx", fault)}), text) << fault;
    EXPECT_EQ(client.create_scene(squares(1), fault).display_name(), fault) << "served after: " << fault;
  }
  EXPECT_NE(refusal({beginning("room.fbx"), piece("room.fbx", "eat memory")}), "accepted");
  EXPECT_EQ(client.create_scene(squares(1), "").face_count(), 1u);
}

TEST_F(ImportScene, AReaderEndsWithItsCall) {
  ImporterOptions patient = faulty;
  patient.patience = std::chrono::hours(1);
  restart(with_importer(patient));
  grpc::ClientContext context;
  const auto writer = stub_->ImportScene(&context, &scene_);
  writer->Write(beginning("room.fbx"));
  writer->Write(piece("room.fbx", "hang"));
  writer->WritesDone();
  Client client(server_->channel());
  EXPECT_EQ(client.create_scene(squares(1), "").face_count(), 1u) << "other calls are served meanwhile";
  context.TryCancel();
  EXPECT_EQ(writer->Finish().error_code(), grpc::CANCELLED);
}

TEST_F(ImportScene, AMissingProgramIsNoFaultOfTheFile) {
  ImporterOptions nowhere;
  nowhere.program = "/nowhere/alvor-import";
  restart(with_importer(nowhere));
  EXPECT_EQ(refusal({beginning("room.obj"), piece("room.obj", room_text)}).substr(0, 3), "13 ");
}

TEST_F(ImportScene, TheClientSendsWhatTheServerAsksFor) {
  Client client(server_->channel());
  v1::ImportOptions options;
  options.set_scene_file("room.obj");
  Names asked;
  const v1::Scene scene = client.import_scene(options, room_text, [&](const std::string& name) -> std::optional<std::string> {
    asked.push_back(name);
    if (name == "a.mtl") return lamp + "map_Ke glow.png\n";
    return std::nullopt;
  });
  EXPECT_EQ(asked, (Names{"a.mtl", "b.mtl", "glow.png"}));
  EXPECT_EQ(scene.warnings(0), "material library 'b.mtl' cannot be read");
}

TEST_F(ImportScene, MoreMissingNamesThanAnErrorHoldsComeInTurns) {
  std::string text;
  for (int n = 0; n < 300; ++n) text += "mtllib library_of_materials_" + std::to_string(n) + ".mtl\n";
  Client client(server_->channel());
  v1::ImportOptions options;
  options.set_scene_file("room.obj");
  std::size_t asked = 0;
  const v1::Scene scene = client.import_scene(options, text + triangle, [&](const std::string&) {
    ++asked;
    return std::optional<std::string>(lamp);
  });
  EXPECT_EQ(asked, 300u);
  EXPECT_EQ(scene.face_count(), 1u);
}

}  // namespace
}  // namespace alvor
