// Tests calls of several tenants over one TLS connection: each sees only its own data, whatever the others do meanwhile.

#include "server/access/listening.h"
#include "server/base/sha256.h"
#include "server/rpc/service.h"
#include "tests/server/sample_scenes.h"

#include "alvor/v1/scene_service.grpc.pb.h"
#include "alvor/v1/solve_service.grpc.pb.h"
#include "proto/codec.h"

#include <grpcpp/grpcpp.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <thread>

namespace alvor {
namespace {

namespace fs = std::filesystem;

const std::array<std::string, 5> names{"ali", "bob", "cho", "dee", "eva"};

/// A server with TLS and a token for each tenant, and one channel to it.
class TenantsTest : public testing::Test {
 protected:
  TenantsTest() {
    fs::create_directories(folder_);
    const std::string make =
        "cd '" + folder_.string() +
        "' && openssl req -x509 -newkey ec -pkeyopt ec_paramgen_curve:prime256v1 -nodes -days 2 -subj /CN=localhost "
        "-addext subjectAltName=DNS:localhost -keyout key.pem -out cert.pem 2> /dev/null";
    EXPECT_EQ(std::system(make.c_str()), 0);
    std::ofstream tokens(folder_ / "tokens");
    for (const std::string& name : names) tokens << name << " " << sha256("token of " + name) << "\n";
    tokens.close();
    ListenOptions listen;
    listen.address = "localhost:0";
    listen.certificate = folder_ / "cert.pem";
    listen.key = folder_ / "key.pem";
    listen.tokens = folder_ / "tokens";
    ServiceOptions options;
    options.tokens = std::make_shared<const BearerTokens>(*tokens_of(listen));
    service_ = std::make_unique<Service>(options);
    grpc::ServerBuilder builder;
    int port = 0;
    builder.AddListeningPort(listen.address, credentials_of(listen), &port);
    service_->register_with(builder);
    server_ = builder.BuildAndStart();
    std::ostringstream root;
    root << std::ifstream(folder_ / "cert.pem").rdbuf();
    channel_ = grpc::CreateChannel("localhost:" + std::to_string(port), grpc::SslCredentials({root.str(), "", ""}));
  }
  ~TenantsTest() override {
    service_->shut_down();
    server_->Shutdown();
    fs::remove_all(folder_);
  }

  std::shared_ptr<grpc::Channel> channel_;

 private:
  const fs::path folder_ = fs::temp_directory_path() / ("alvor_tenants_" + std::to_string(getpid()));
  std::unique_ptr<Service> service_;
  std::unique_ptr<grpc::Server> server_;
};

struct Call : grpc::ClientContext {
  explicit Call(const std::string& name) { AddMetadata("authorization", "Bearer token of " + name); }
};

/// One tenant's calls.
class Tenant {
 public:
  Tenant(const std::shared_ptr<grpc::Channel>& channel, std::string name)
      : name_(std::move(name)), scenes_(v1::SceneService::NewStub(channel)), solves_(v1::SolveService::NewStub(channel)) {}

  /// Creates a scene and a solve. The scenes of different tenants are equal.
  void settle() {
    Call call(name_);
    v1::Scene made;
    const auto writer = scenes_->CreateScene(&call, &made);
    v1::CreateSceneRequest message;
    message.mutable_scene()->set_display_name(name_);
    writer->Write(message);
    SceneSlicer(squares(2)).next(*message.mutable_chunk());
    writer->Write(message);
    writer->WritesDone();
    EXPECT_TRUE(writer->Finish().ok());
    scene = made.name();
    Call next(name_);
    v1::CreateSolveRequest request;
    request.set_parent(scene);
    v1::Solve begun;
    EXPECT_TRUE(solves_->CreateSolve(&next, request, &begun).ok());
    solve = begun.name();
  }

  /// Returns the status of each call that names a scene or a solve, except deletions.
  std::vector<grpc::StatusCode> statuses(const std::string& of_scene, const std::string& of_solve) {
    std::vector<grpc::StatusCode> all{
        get_scene(of_scene), read<v1::ReadSceneResponse, v1::ReadSceneRequest>(&v1::SceneService::Stub::ReadScene, of_scene),
        read<v1::ReadMeshResponse, v1::ReadMeshRequest>(&v1::SceneService::Stub::ReadMesh, of_scene),
        read<v1::ReadImagesResponse, v1::ReadImagesRequest>(&v1::SceneService::Stub::ReadImages, of_scene)};
    all.push_back(change(&v1::SolveService::Stub::GetSolve, v1::GetSolveRequest(), of_solve));
    all.push_back(change(&v1::SolveService::Stub::CancelSolve, v1::CancelSolveRequest(), of_solve));
    v1::CreateSolveRequest create;
    create.set_parent(of_scene);
    Call call(name_);
    v1::Solve made;
    all.push_back(solves_->CreateSolve(&call, create, &made).error_code());
    return all;
  }

  grpc::StatusCode get_scene(const std::string& name) {
    Call call(name_);
    v1::GetSceneRequest request;
    request.set_name(name);
    v1::Scene found;
    return scenes_->GetScene(&call, request, &found).error_code();
  }

  grpc::StatusCode delete_solve(const std::string& name) {
    Call call(name_);
    v1::DeleteSolveRequest request;
    request.set_name(name);
    google::protobuf::Empty nothing;
    return solves_->DeleteSolve(&call, request, &nothing).error_code();
  }

  /// Returns the names in this tenant's lists that belong to others.
  std::vector<std::string> foreign_scenes() {
    Call call(name_);
    v1::ListScenesResponse listed;
    EXPECT_TRUE(scenes_->ListScenes(&call, {}, &listed).ok());
    std::vector<std::string> foreign;
    for (const v1::Scene& each : listed.scenes())
      if (each.display_name() != name_) foreign.push_back(each.display_name());
    return foreign;
  }

  std::string scene, solve;

 private:
  template <class Response, class Request, class Method>
  grpc::StatusCode read(Method method, const std::string& name) {
    Call call(name_);
    Request request;
    request.set_name(name);
    const auto reader = (scenes_.get()->*method)(&call, request);
    for (Response part; reader->Read(&part);) {}
    return reader->Finish().error_code();
  }
  template <class Method, class Request>
  grpc::StatusCode change(Method method, Request request, const std::string& name) {
    Call call(name_);
    request.set_name(name);
    v1::Solve answer;
    return (solves_.get()->*method)(&call, request, &answer).error_code();
  }

  const std::string name_;
  std::unique_ptr<v1::SceneService::Stub> scenes_;
  std::unique_ptr<v1::SolveService::Stub> solves_;
};

TEST_F(TenantsTest, SeeTheirOwnOverOneConnection) {
  std::vector<std::unique_ptr<Tenant>> tenants;
  for (const std::string& name : names) tenants.push_back(std::make_unique<Tenant>(channel_, name));
  for (const auto& tenant : tenants) tenant->settle();
  std::vector<std::thread> threads;
  for (std::size_t t = 0; t < tenants.size(); ++t)
    threads.emplace_back([&, t] {
      for (int round = 0; round < 20; ++round)
        for (std::size_t other = 0; other < tenants.size(); ++other) {
          const auto expected = other == t ? grpc::StatusCode::OK : grpc::StatusCode::NOT_FOUND;
          const auto all = tenants[t]->statuses(tenants[other]->scene, tenants[other]->solve);
          // A solve that has ended cannot be cancelled: the call returns FAILED_PRECONDITION.
          for (std::size_t n = 0; n < all.size(); ++n) {
            EXPECT_TRUE(all[n] == expected || (other == t && n == 4 && all[n] == grpc::StatusCode::FAILED_PRECONDITION))
                << names[t] << " of " << names[other] << ", call " << n << ": " << all[n];
          }
          EXPECT_EQ(tenants[t]->foreign_scenes(), std::vector<std::string>());
          if (other != t) {
            EXPECT_EQ(tenants[t]->delete_solve(tenants[other]->solve), grpc::StatusCode::NOT_FOUND);
          }
        }
    });
  for (std::thread& thread : threads) thread.join();
}

TEST_F(TenantsTest, StrangersAmongThemAreRefused) {
  Tenant ali(channel_, "ali"), stranger(channel_, "nobody");
  ali.settle();
  for (int n = 0; n < 50; ++n) {
    EXPECT_EQ(ali.get_scene(ali.scene), grpc::StatusCode::OK);
    EXPECT_EQ(stranger.get_scene(ali.scene), grpc::StatusCode::UNAUTHENTICATED);
  }
}

}  // namespace
}  // namespace alvor
