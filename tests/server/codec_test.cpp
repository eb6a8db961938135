#include "proto/codec.h"
#include "proto/leaf_codec.h"
#include "proto/mesh_codec.h"

#include "tests/cutouts.h"
#include "tests/environments.h"
#include "tests/server/sample_scenes.h"

#include <gtest/gtest.h>

namespace alvor {
namespace {

Scene assemble(const std::vector<v1::GeometryChunk>& chunks) {
  SceneAssembler assembler;
  for (const auto& chunk : chunks) EXPECT_FALSE(assembler.add(chunk));
  return assembler.take();
}

std::vector<v1::GeometryChunk> slice(const Scene& scene, std::size_t max_bytes) {
  std::vector<v1::GeometryChunk> chunks;
  SceneSlicer slicer(scene, max_bytes);
  for (v1::GeometryChunk chunk; slicer.next(chunk);) chunks.push_back(chunk);
  return chunks;
}

TEST(SceneCodec, EncodeDecodeEncodeGivesTheSameBytes) {
  Scene scene = squares(50);
  scene.materials.push_back({"mirror", {}, {0.1, 0.2, 0.3}, true});
  scene.faces[7].material = 1;
  const auto once = slice(scene, 1 << 20);
  ASSERT_EQ(once.size(), 1u);
  const auto twice = slice(assemble(once), 1 << 20);
  ASSERT_EQ(twice.size(), 1u);
  EXPECT_EQ(once[0].SerializeAsString(), twice[0].SerializeAsString());
}

/// Returns a scene with a light of each kind, all of whose fields that count differ from their defaults.
Scene scene_with_lights() {
  Scene scene = squares(3);
  scene.quantity = Quantity::photometric;
  Light bulb{"bulb", LightKind::point, {1, 2, 3}, {4, 5, 6}},
      spot{"spot", LightKind::spot, {7, 8, 9}, {1, 2, 3}, {0, 1, 0}, 0.2, 0.7}, sun{"sun", LightKind::directional, {10, 20, 30}};
  bulb.radius = 0.5;
  sun.direction = {1, 0, 0};
  sun.angular_diameter = 0.01;
  Light downlight{"downlight", LightKind::luminaire, {1, 1, 1}, {3, 2, 1}};
  downlight.across = {0, 1, 0};
  downlight.opening = {LuminousOpening::Shape::box, 0.1, 0.2, 0.3};
  downlight.electrical_watts = 12.5;
  const PhotometricWeb web{PhotometricWeb::Axis::across, {-90, 0, 90}, {0, 180}, {1, 2, 3, 4, 5, 6}};
  downlight.web = std::make_shared<PhotometricWeb>(web);
  Light other{"other", LightKind::luminaire, {2, 2, 2}};
  other.web = std::make_shared<PhotometricWeb>(PhotometricWeb{PhotometricWeb::Axis::aim, {0}, {0, 90}, {1, 0}});
  scene.lights = {bulb, spot, sun, downlight, other, downlight};
  return scene;
}

TEST(SceneCodec, LightsAndTheQuantityArrive) {
  for (const std::size_t bytes : {256u, 1u << 20}) {
    const Scene arrived = assemble(slice(scene_with_lights(), bytes));
    EXPECT_EQ(arrived.quantity, Quantity::photometric);
    ASSERT_EQ(arrived.lights.size(), 6u);
    EXPECT_EQ(arrived.lights, scene_with_lights().lights);
    EXPECT_EQ(arrived.lights[3].web, arrived.lights[5].web);  // sent once
    EXPECT_NE(arrived.lights[3].web, arrived.lights[4].web);
  }
}

TEST(SceneCodec, ObjectsAndNorthArrive) {
  Scene scene = squares(5);
  scene.north_degrees = 30;
  scene.objects = {{"all \xff", std::nullopt, {}, 0, 0},
                   {"floor", 0, {{0, 1, 0}, {-1, 0, 0}, {0, 0, 2}, {1e-9, 2, 3}}, 0, 1},
                   {"rest", 0, {}, 2, 3}};
  const Scene back = assemble(slice(scene, 256));
  EXPECT_EQ(back.north_degrees, 30);
  scene.objects[0].name = "all ?";
  EXPECT_EQ(back.objects, scene.objects);
}

TEST(SceneCodec, AnObjectWithHalfATransformIsRefusedByName) {
  v1::GeometryChunk chunk;
  v1::SceneObject& object = *chunk.add_objects();
  object.set_name("chair");
  for (int n = 0; n < 11; ++n) object.add_transform(n);
  EXPECT_EQ(SceneAssembler().add(chunk)->text(), "object 'chair': its transform has 11 numbers, needs 12");
}

Scene scene_with_environments() {
  Scene scene = scene_with_lights();
  const Light one = test::environment({4, 2}, [](Vec3 d) { return Rgb{1 + d.y, 2, 3}; });
  const Light other = test::environment({2, 1}, [](Vec3) { return Rgb{7, 8, 9}; });
  scene.lights = {one, other, one};
  return scene;
}

TEST(SceneCodec, EnvironmentMapsAreSentOnceAndShared) {
  for (const std::size_t bytes : {256, 1 << 20}) {
    const Scene arrived = assemble(slice(scene_with_environments(), bytes));
    EXPECT_EQ(arrived.lights, scene_with_environments().lights);
    EXPECT_EQ(arrived.lights[0].environment, arrived.lights[2].environment);
    EXPECT_NE(arrived.lights[0].environment, arrived.lights[1].environment);
  }
}

TEST(SceneCodec, EnvironmentMapsThatContradictThemselvesAreRefusedByName) {
  const auto refusal = [](auto change) {
    v1::GeometryChunk chunk = slice(scene_with_environments(), 1 << 20)[0];
    change(chunk);
    SceneAssembler assembler;
    const auto fault = assembler.add(chunk);
    return fault ? fault->text() : "";
  };
  EXPECT_EQ(refusal([](auto& chunk) { chunk.mutable_lights(2)->set_environment(2); }),
            "light 2 'surroundings': its environment map 2 is not known");
  EXPECT_EQ(refusal([](auto& chunk) { chunk.mutable_environments(1)->add_radiance(1); }),
            "chunk 0, environments: a map of 2 x 1 pixels has 7 values, needs 6");
  EXPECT_EQ(refusal([](auto& chunk) { chunk.mutable_environments(1)->set_columns(0xffffffff); }),
            "chunk 0, environments: a map has 4294967295 x 1 pixels, at most 256 x 128 are possible");
  EXPECT_EQ(refusal([](auto& chunk) {
              for (int n = 0; n < 63; ++n) chunk.add_environments();
            }),
            "chunk 0, environments: the scene has 65 environment maps, at most 64 are possible");
}

TEST(SceneCodec, ALuminaireWithoutItsWebIsRefusedByName) {
  v1::GeometryChunk chunk = slice(scene_with_lights(), 1 << 20)[0];
  chunk.mutable_lights(4)->set_web(2);
  const auto fault = SceneAssembler().add(chunk);
  ASSERT_TRUE(fault);
  EXPECT_EQ(fault->text(), "light 4 'other': its web 2 is not known");
}

TEST(SceneCodec, ALightOfNoKnownKindIsRefusedByName) {
  for (const int kind : {0, 77}) {
    v1::GeometryChunk chunk = slice(scene_with_lights(), 1 << 20)[0];
    chunk.mutable_lights(1)->set_kind(static_cast<v1::Light::Kind>(kind));
    const auto fault = SceneAssembler().add(chunk);
    ASSERT_TRUE(fault);
    EXPECT_EQ(fault->text(), "light 1 'spot': its kind " + std::to_string(kind) + " is not known");
  }
}

TEST(MeshCodec, MessagesWithLongNamesStayBelowGrpcsLimit) {
  Scene scene = squares(3);
  for (int n = 0; n < 9000; ++n) scene.materials.push_back({std::string(1000, 'x'), {}, {}, false});
  const BaseMesh mesh(scene);
  MeshSlicer slicer(mesh);
  std::size_t materials = 0, roots = 0;
  for (v1::ReadMeshResponse message; slicer.next(message);) {
    EXPECT_LT(message.ByteSizeLong(), 4u << 20);
    materials += static_cast<std::size_t>(message.scene_materials_size());
    roots += static_cast<std::size_t>(message.corner_counts_size());
  }
  EXPECT_EQ(materials, scene.materials.size());
  EXPECT_EQ(roots, mesh.roots().size());
}

TEST(SceneCodec, ManySmallChunksCarryTheSameScene) {
  const Scene scene = squares(200);
  const auto chunks = slice(scene, 300);
  EXPECT_GT(chunks.size(), 50u);
  for (const auto& chunk : chunks) EXPECT_LE(chunk.ByteSizeLong(), 300u);
  EXPECT_EQ(slice(assemble(chunks), 1 << 20)[0].SerializeAsString(), slice(scene, 1 << 20)[0].SerializeAsString());
}

TEST(SceneCodec, FaceLargerThanAChunkTravelsWhole) {
  Scene scene = squares(1);
  scene.add_face(std::vector<std::uint32_t>(1000, 3), 0);
  const Scene arrived = assemble(slice(scene, 300));
  ASSERT_EQ(arrived.faces.size(), 2u);
  EXPECT_EQ(arrived.faces[1].corner_count, 1000u);
}

Scene textured_squares(std::size_t count) {
  Scene scene = squares(count);
  const auto image = std::make_shared<const ColourImage>(test::noise(40, 30)),
             other = std::make_shared<const ColourImage>(test::noise(3, 2));
  for (const auto& each : {image, other, image}) {
    scene.materials.push_back(test::textured(*each, {0.5, 0.25, 1}));
    scene.materials.back().texture->image = each;
  }
  scene.materials.back().texture->wrap_s = Wrap::mirror, scene.materials.back().texture->wrap_t = Wrap::clamp;
  for (std::size_t f = 0; f < count; ++f) scene.faces[f].material = static_cast<std::uint32_t>(f % scene.materials.size());
  for (std::size_t c = 0; c < scene.corners.size(); ++c) {
    scene.texture_points.push_back({static_cast<float>(c) / 7, -static_cast<float>(c)});
    scene.corner_colours.push_back({1 / (1 + static_cast<float>(c)), 0.5F, 1});
  }
  return scene;
}

TEST(SceneCodec, ChunksCarryTexturesAndEachImageOnce) {
  const Scene scene = textured_squares(50);
  const auto chunks = slice(scene, 300);
  int images = 0;
  for (const auto& chunk : chunks) {
    images += chunk.images_size();
    EXPECT_LE(chunk.ByteSizeLong(), 300u);
  }
  EXPECT_EQ(images, 2);
  const Scene arrived = assemble(chunks);
  EXPECT_EQ(arrived.corner_colours, scene.corner_colours);
  for (std::size_t m = 0; m < scene.materials.size(); ++m) {
    const auto &sent = scene.materials[m].texture, &found = arrived.materials[m].texture;
    ASSERT_EQ(sent.has_value(), found.has_value());
    if (!sent) continue;
    EXPECT_EQ(sent->image->texels, found->image->texels);
    EXPECT_EQ(sent->image->columns, found->image->columns);
    EXPECT_EQ(sent->factor, found->factor);
    EXPECT_EQ(sent->wrap_s, found->wrap_s);
    EXPECT_EQ(sent->wrap_t, found->wrap_t);
    EXPECT_EQ(scene.materials[m].reflectance, arrived.materials[m].reflectance);
  }
  for (const Face& face : scene.faces)
    for (std::uint32_t c = face.first_corner; c < face.first_corner + face.corner_count; ++c) {
      if (!scene.materials[face.material].texture) continue;
      EXPECT_EQ(scene.texture_points[c], arrived.texture_points[c]);
    }
  EXPECT_EQ(slice(arrived, 1 << 20)[0].SerializeAsString(), slice(scene, 1 << 20)[0].SerializeAsString());
}

TEST(SceneCodec, ChunksCarryHolesAndWhatComesThrough) {
  Scene scene = textured_squares(50);
  Texture& texture = *scene.materials.back().texture;
  texture.image = std::make_shared<const ColourImage>(test::with_holes(*texture.image));
  scene.materials.back().reflectance = texture.factor * mean_surface(*texture.image).reflectance;
  scene.materials[0].two_sided = true;
  scene.materials[0].diffuse_transmittance = {0.1, 0.2, 0.05};
  const Scene arrived = assemble(slice(scene, 300));
  EXPECT_TRUE(arrived.materials.back().texture->image->has_opacity);
  EXPECT_EQ(arrived.materials.back().texture->image->texels, texture.image->texels);
  EXPECT_EQ(arrived.materials[0].diffuse_transmittance, scene.materials[0].diffuse_transmittance);
  EXPECT_EQ(slice(arrived, 1 << 20)[0].SerializeAsString(), slice(scene, 1 << 20)[0].SerializeAsString());
}

TEST(SceneCodec, TexturedMaterialsReflectTheMeanOfTheirImageWhateverTheySay) {
  auto chunk = slice(textured_squares(4), 1 << 20)[0];
  for (v1::Material& material : *chunk.mutable_materials()) *material.mutable_reflectance() = encode(Rgb{0.9, 0.9, 0.9});
  const Scene scene = assemble({chunk});
  EXPECT_EQ(scene.materials.back().reflectance,
            scene.materials.back().texture->factor * mean_surface(*scene.materials.back().texture->image).reflectance);
}

TEST(SceneCodec, ImagesWithoutAllTheirTexelsAreAFault) {
  auto chunk = slice(textured_squares(4), 1 << 20)[0];
  chunk.mutable_texels()->resize(chunk.texels().size() - 1);
  const auto fault = find_fault(assemble({chunk}));
  ASSERT_TRUE(fault);
  EXPECT_EQ(fault->reason, "its image of 3 x 2 texels has 17 bytes, needs 18");
}

TEST(SceneCodec, ChunksWithUnsoundTexturesAreRefusedByName) {
  struct Case {
    const char* fault;
    void (*spoil)(v1::GeometryChunk&);
  };
  const Case cases[] = {
      {"chunk 0, images: an image has 0 x 30 texels, 1 x 1 to 8192 x 8192 are possible",
       [](auto& c) { c.mutable_images(0)->set_columns(0); }},
      {"chunk 0, images: an image has 8193 x 30 texels, 1 x 1 to 8192 x 8192 are possible",
       [](auto& c) { c.mutable_images(0)->set_columns(8193); }},
      {"chunk 0, images: the scene has 67108870 texels, at most 67108864 are possible",
       [](auto& c) { c.mutable_images(0)->set_columns(8192), c.mutable_images(0)->set_rows(8192); }},
      {"chunk 0, texels: there are 3619 bytes for 1206 texels, which have 3618 bytes",
       [](auto& c) { c.mutable_texels()->push_back(0); }},
      {"chunk 0, texture_coordinates: has 33 numbers, needs two for each of 16 corners",
       [](auto& c) { c.add_texture_coordinates(1); }},
      {"chunk 0, corner_colors: has 47 numbers, needs three for each of 16 corners",
       [](auto& c) { c.mutable_corner_colors()->RemoveLast(); }},
      {"material 'textured': image 2 of its texture is not known",
       [](auto& c) { c.mutable_materials(c.materials_size() - 1)->mutable_texture()->set_image(2); }},
      {"chunk 0, images: the scene has 10002 images, at most 10000 are possible",
       [](auto& c) {
         for (int n = 0; n < 10'000; ++n) *c.add_images() = c.images(1);
       }},
  };
  const v1::GeometryChunk good = slice(textured_squares(4), 1 << 20)[0];
  for (const Case& spoilt : cases) {
    v1::GeometryChunk bad = good;
    spoilt.spoil(bad);
    const auto fault = SceneAssembler().add(bad);
    ASSERT_TRUE(fault) << spoilt.fault;
    EXPECT_EQ(fault->text(), spoilt.fault);
  }
}

TEST(SceneCodec, ChunksThatContradictThemselvesAreRefusedByName) {
  struct Case {
    const char* fault;
    void (*spoil)(v1::GeometryChunk&);
  };
  const Case cases[] = {
      {"chunk 1, vertex_coordinates: has 13 numbers, needs three per vertex", [](auto& c) { c.add_vertex_coordinates(1); }},
      {"chunk 1, face_materials: has 2 entries for 1 faces", [](auto& c) { c.add_face_materials(0); }},
      {"chunk 1, corner_vertices: has 5 entries, but face_corner_counts add up to 4", [](auto& c) { c.add_corner_vertices(0); }},
      {"chunk 1, corner_vertices: has 4 entries, but face_corner_counts add up to 4294967295",
       [](auto& c) { c.set_face_corner_counts(0, 0xffffffff); }},
      {"face 1: has 2 corners, needs at least 3", [](auto& c) { c.set_face_corner_counts(0, 2); }},
  };
  const v1::GeometryChunk good = slice(squares(1), 1 << 20)[0];
  for (const Case& spoilt : cases) {
    v1::GeometryChunk bad = good;
    spoilt.spoil(bad);
    SceneAssembler assembler;
    ASSERT_FALSE(assembler.add(good));
    const auto fault = assembler.add(bad);
    ASSERT_TRUE(fault) << spoilt.fault;
    EXPECT_EQ(fault->text(), spoilt.fault);
    EXPECT_EQ(assembler.scene().vertices.size(), 4u) << "a bad chunk leaves nothing behind";
  }
}

Delta sample_delta() {
  Delta delta;
  delta.from_revision = 3;
  delta.to_revision = 5;
  delta.head = 9;
  delta.values = {{PatchId::root(0).child(2), {1, 0.1f, 0}}, {PatchId::root(7), {3e-30f, 2, 1e30f}}};
  delta.steps.resize(2);
  delta.steps[0] = {4, 0.1, 3, 5, 1'000'000'000'000, 8, 0.5, 0.25, 0, {}};
  delta.steps[1] = {5, 1.9999999999, 4, 6, 1'000'000'000'001, 9, 0.3, 0.2, 0.05, 0.125, 0.75, 7, true, {1, 2, 3}};
  return delta;
}

TEST(DeltaCodec, EncodeDecodeEncodeGivesTheSameBytes) {
  v1::WatchSolveResponse once, twice;
  encode(sample_delta(), once);
  Delta decoded;
  ASSERT_FALSE(decode(once, decoded));
  EXPECT_EQ(decoded.values, sample_delta().values);
  encode(decoded, twice);
  EXPECT_EQ(once.SerializeAsString(), twice.SerializeAsString());
}

TEST(DeltaCodec, FramesThatContradictThemselvesAreRefused) {
  v1::WatchSolveResponse message;
  encode(sample_delta(), message);
  Delta decoded;
  const v1::WatchSolveResponse good = message;
  const auto refusal = [&](auto&& spoil) {
    message = good;
    spoil(*message.mutable_leaves());
    const auto fault = decode(message, decoded);
    return fault ? fault->text() : "none";
  };
  EXPECT_EQ(refusal([](auto& leaves) { leaves.set_count(3); }), "leaves: raw_size: 26 bytes cannot be 3 leaves");
  EXPECT_EQ(refusal([](auto& leaves) { leaves.set_count(1u << 31); }), "leaves: count: 2147483648 leaves, at most 52428");
  EXPECT_EQ(refusal([](auto& leaves) { leaves.set_raw_size(1u << 31); }), "leaves: raw_size: 2147483648 bytes, at most 262144");
  EXPECT_EQ(refusal([](auto& leaves) { leaves.set_raw_size(28); }), "leaves: zstd: is not 28 bytes compressed");
  EXPECT_EQ(refusal([](auto& leaves) { leaves.mutable_zstd()->pop_back(); }), "leaves: zstd: is not 26 bytes compressed");
  EXPECT_EQ(refusal([](auto& leaves) { leaves.set_detail(static_cast<v1::Detail>(9)); }), "leaves: detail: is not one");
  EXPECT_EQ(refusal([](auto& leaves) { leaves.set_scale(1000); }), "leaves: scale: is not between -200 and 200");
  const auto with_value = [&](float value) {
    return refusal([value](auto& leaves) {
      leaves = encode_leaves(std::vector<LeafValue>{{PatchId::root(0), {value, 0, 0}}}, Detail::exact, SharedExponent(0));
    });
  };
  EXPECT_EQ(with_value(1), "none");
  for (const float bad : {NAN, INFINITY, -1.0f}) EXPECT_NE(with_value(bad).find("irradiance"), std::string::npos);
}

TEST(DurationCodec, TakesAnyNumber) {
  for (const double seconds : {0.0, 1e-9, 0.9999999999, 1.25, -3.5, 86400.0 * 365})
    EXPECT_NEAR(decode_seconds(encode_seconds(seconds)), seconds, 1e-9);
  EXPECT_EQ(encode_seconds(NAN).seconds(), 0);
  EXPECT_EQ(encode_seconds(INFINITY).seconds(), 315'576'000'000);
}

TEST(TextCodec, MakesValidUtf8OfAnything) {
  EXPECT_EQ(as_utf8("Küche \xf0\x9f\x92\xa1"), "Küche \xf0\x9f\x92\xa1");
  EXPECT_EQ(as_utf8("K\xfc"
                    "che"),
            "K?che");
  EXPECT_EQ(as_utf8("\xc0\x80 \xed\xa0\x80 \xe2\x82"), "?? ??? ??");
}

TEST(PlanCodec, EveryFeatureArrivesAsItWasDecided) {
  std::vector<PlannedFeature> plan;
  for (const Feature feature : all_features)
    plan.push_back({feature, plan.size() % 2 == 0, "because of " + std::string(text(feature)), "much"});
  EXPECT_EQ(decode(encode(plan)), plan);
}

TEST(PlanCodec, FeaturesOfALaterVersionAreLeftOut) {
  v1::Plan message;
  message.add_features()->set_kind(static_cast<v1::PlannedFeature::Kind>(99));
  EXPECT_TRUE(decode(message).empty());
}

}  // namespace
}  // namespace alvor
