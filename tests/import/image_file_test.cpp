// Tests which image files are decoded, and that WebP is read as other formats are.

#include "import/formats/image_file.h"
#include "import/base/import_error.h"
#include "import/formats/import_scene.h"
#include "import/formats/texture_colour.h"
#include "tests/import/texture_images.h"

#include <gtest/gtest.h>

namespace alvor {
namespace {

using Names = std::vector<std::string>;
using test::Texels;
using Values = std::vector<std::uint8_t>;

// Its second texel cannot be seen, but has a colour.
const Texels mixed{{188, 0, 0, 255}, {0, 188, 9, 0}, {9, 90, 200, 128}, {255, 255, 255, 1}, {0, 0, 0, 255}, {1, 2, 3, 4}};
constexpr AlphaUse blended{AlphaUse::Kind::blended}, cut{AlphaUse::Kind::cut};

std::span<const unsigned char> bytes_of(const std::string& file) {
  return {reinterpret_cast<const unsigned char*>(file.data()), file.size()};
}

std::optional<ColourImage> colours(const std::string& file, const AlphaUse& alpha = {}) {
  return decode_colours(bytes_of(file), alpha);
}

TEST(Webp, LosslessGivesTheTextureOfTgaWithTheSamePixels) {
  const std::string webp = test::webp(3, mixed), tga = test::tga(3, mixed);
  for (const AlphaUse& alpha : {AlphaUse{}, blended, cut}) {
    const auto found = colours(webp, alpha), expected = colours(tga, alpha);
    ASSERT_TRUE(found && expected);
    EXPECT_EQ(found->columns, 3u);
    EXPECT_EQ(found->rows, 2u);
    EXPECT_EQ(found->has_opacity, expected->has_opacity);
    EXPECT_EQ(found->texels, expected->texels);
    const auto mean = mean_texel(bytes_of(webp), alpha), expected_mean = mean_texel(bytes_of(tga), alpha);
    ASSERT_TRUE(mean && expected_mean);
    EXPECT_EQ(mean->colour, expected_mean->colour);
    EXPECT_EQ(mean->opacity, expected_mean->opacity);
    EXPECT_EQ(mean->level, expected_mean->level);
    EXPECT_TRUE(mean->has_alpha);
  }
  EXPECT_EQ(decode_opacity(bytes_of(webp), 0.5)->texels, decode_opacity(bytes_of(tga), 0.5)->texels);
}

TEST(Webp, WithoutAlphaIsOpaque) {
  const std::string webp = test::webp(3, mixed, {.has_alpha = false});
  EXPECT_FALSE(mean_texel(bytes_of(webp), blended)->has_alpha);
  EXPECT_FALSE(colours(webp, blended)->has_opacity);
  EXPECT_EQ(colours(webp, blended)->texels, colours(test::tga(3, mixed, false))->texels);
  const auto opacity = decode_opacity(bytes_of(webp), 1);
  EXPECT_EQ(opacity->texels[3], 63) << "the mean of red, green and blue, because the image has no alpha";
}

TEST(Webp, WithLossKeepsItsAlpha) {
  const Texels texels(64, {188, 100, 20, 200});
  const auto found = colours(test::webp(8, texels, {.is_lossless = false}), blended);
  ASSERT_TRUE(found && found->has_opacity);
  constexpr int loss = 6;  // of one colour at the encoder's default quality of 75
  for (std::size_t i = 0; i < found->texels.size(); ++i)
    EXPECT_NEAR(found->texels[i], texels[0][i % 4], i % 4 == 3 ? 0 : loss) << i;
}

TEST(Webp, ThatIsCutOffIsNone) {
  for (const bool is_lossless : {true, false}) {
    const std::string whole = test::webp(3, mixed, {.is_lossless = is_lossless});
    ASSERT_TRUE(colours(whole));
    for (std::size_t size = 0; size < whole.size(); ++size) EXPECT_FALSE(colours(whole.substr(0, size))) << size;
  }
}

TEST(Webp, OfAFewBytesIsNotDecodedIntoHundredsOfMillionsOfPixels) {
  const auto flat = colours(test::webp_of_one_colour(3, 1), blended);
  ASSERT_TRUE(flat);
  EXPECT_EQ(flat->texels, (Values{60, 100, 20, 60, 100, 20, 60, 100, 20})) << "opaque: the file says that it has no alpha";
  EXPECT_TRUE(colours(test::webp_of_one_colour(4096, 4096)));
  const std::string bomb = test::webp_of_one_colour(16383, 16383);
  EXPECT_EQ(bomb.size(), 32u);
  EXPECT_FALSE(colours(bomb));
  EXPECT_FALSE(mean_texel(bytes_of(bomb)));
  EXPECT_FALSE(colours(test::webp_of_one_colour(4096, 4097)));
  EXPECT_TRUE(colours(test::webp_of_one_colour(4096, 4097) + std::string(4000, '\0'))) << "long enough for as many in PNG";
}

TEST(Webp, ThatMovesIsNone) {
  const std::string size = test::little_endian(2, 3) + test::little_endian(0, 3);  // 3 x 1, each less 1
  const auto extended = [&](unsigned flags, const std::string& chunks) {
    return test::webp_of_chunks(test::riff_chunk("VP8X", test::little_endian(flags, 4) + size) + chunks);
  };
  EXPECT_TRUE(colours(extended(0, test::flat_webp_chunk(3, 1))));
  const std::string frame = test::little_endian(0, 6) + size + test::little_endian(100, 4) + test::flat_webp_chunk(3, 1);
  EXPECT_FALSE(colours(extended(2, test::riff_chunk("ANIM", std::string(6, '\0')) + test::riff_chunk("ANMF", frame))));
}

TEST(ImageFiles, ThatOnlyBeginAsWebpAreNone) {
  for (const char* text : {"", "R", "RIFF", "RIFF\4WEBP", "RIFF\4AAAWEBP", "RIFF\4AAAWAVEfmt ", "WEBP"})
    EXPECT_FALSE(colours(text));
}

const std::string two_by_one = test::webp(2, {{188, 0, 0, 255}, {0, 188, 0, 0}});
const std::string one_by_two = test::tga(1, {{0, 0, 188, 255}, {0, 0, 9, 0}});

/// Returns a glTF file with a triangle that shows a texture. Its images are `plain.tga` and `small.webp`.
SceneFiles room(const std::string& texture, const std::string& more = "",
                const std::string& images = R"({"uri": "plain.tga"}, {"uri": "small.webp"})") {
  SceneFiles files("room.gltf", R"({"asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
      "buffers": [{"byteLength": 60, "uri": "room.bin"}],
      "bufferViews": [{"buffer": 0, "byteLength": 36}, {"buffer": 0, "byteOffset": 36, "byteLength": 24}],
      "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"},
                    {"bufferView": 1, "componentType": 5126, "count": 3, "type": "VEC2"}],
      "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "TEXCOORD_0": 1}, "material": 0}]}],
      "materials": [{"name": "leaf", "pbrMetallicRoughness":
        {"metallicFactor": 0, "baseColorFactor": [0.5, 0.5, 0.5, 1], "baseColorTexture": {"index": 0}}}],
      "textures": [)" + texture + R"(], "images": [)" +
                                    images + "]" + more + "}");
  constexpr std::array<float, 15> numbers{0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 1};
  files.add("room.bin", {reinterpret_cast<const char*>(numbers.data()), sizeof numbers});
  return files;
}

const std::string webp_only = R"({"extensions": {"EXT_texture_webp": {"source": 1}}})";
const std::string webp_or_plain = R"({"source": 0, "extensions": {"EXT_texture_webp": {"source": 1}}})";

/// Returns the columns and rows of the texture that a scene shows; none if it has none.
std::vector<std::uint32_t> shown(SceneFiles files) {
  const Scene scene = import_scene(files, {}).file.scene;
  if (scene.materials.empty() || !scene.materials[0].texture) return {};
  return {scene.materials[0].texture->image->columns, scene.materials[0].texture->image->rows};
}
using Size = std::vector<std::uint32_t>;

TEST(TextureWebp, IsShown) {
  SceneFiles files = room(webp_only, R"(, "extensionsUsed": ["EXT_texture_webp"], "extensionsRequired": ["EXT_texture_webp"])");
  files.add("small.webp", two_by_one);
  const SceneFile file = import_scene(files, {}).file;
  ASSERT_TRUE(file.scene.materials[0].texture);
  EXPECT_EQ(file.scene.materials[0].texture->image->texels, (Values{188, 0, 0, 0, 188, 0}));
  EXPECT_EQ(file.warnings, Names());
}

TEST(TextureWebp, IsPreferredToThePlainImageUnlessItCannotBeRead) {
  SceneFiles files = room(webp_or_plain);
  files.add("plain.tga", one_by_two);
  files.add("small.webp", two_by_one);
  EXPECT_EQ(shown(files), (Size{2, 1}));
  files.add("small.webp", two_by_one.substr(0, 20));
  EXPECT_EQ(shown(files), (Size{1, 2}));
  files.add("plain.tga", "none");
  EXPECT_EQ(import_scene(files, {}).file.warnings, Names{"material 'leaf': texture 'small.webp' cannot be read and is left out"});
}

TEST(TextureWebp, IsAskedForWithThePlainImageAndOneOfThemIsEnough) {
  SceneFiles files = room(webp_or_plain);
  EXPECT_EQ(import_scene(files, {}).missing, (Names{"plain.tga", "small.webp"}));
  SceneFiles without_plain = room(webp_or_plain);
  without_plain.add("small.webp", two_by_one);
  without_plain.declare_absent("plain.tga");
  EXPECT_EQ(shown(without_plain), (Size{2, 1}));
  SceneFiles without_webp = room(webp_or_plain);
  without_webp.add("plain.tga", one_by_two);
  without_webp.declare_absent("small.webp");
  EXPECT_EQ(shown(without_webp), (Size{1, 2}));
  SceneFiles without_both = room(webp_or_plain);
  without_both.declare_absent("plain.tga");
  without_both.declare_absent("small.webp");
  try {
    import_scene(without_both, {});
    FAIL() << "an image is needed";
  } catch (const ImportError& error) {
    EXPECT_STREQ(error.what(), "image 1 'small.webp': is missing beside the scene");
  }
}

TEST(TextureWebp, CanLieInTheSceneFile) {
  // A red and a green texel, written by cwebp -lossless.
  const std::string uri = "data:image/webp;base64,UklGRh4AAABXRUJQVlA4TBIAAAAvAQAAAA9wIt7hjfmPChnR/wA=";
  EXPECT_EQ(shown(room(R"({"extensions": {"EXT_texture_webp": {"source": 0}}})", "", R"({"uri": ")" + uri + R"("})")),
            (Size{2, 1}));
}

TEST(TextureWebp, WithStrangeNumbersIsNone) {
  for (const char* source : {"7", "-1", "1e300", "\"1\"", "null", "{}"}) {
    SceneFiles files = room(R"({"extensions": {"EXT_texture_webp": {"source": )" + std::string(source) + "}}}");
    EXPECT_EQ(import_scene(files, {}).file.warnings, Names{"material 'leaf': texture '0' cannot be read and is left out"})
        << source;
  }
  SceneFiles files = room(R"({"source": 0, "extensions": {"EXT_texture_webp": 5}})");
  files.add("plain.tga", one_by_two);
  EXPECT_EQ(shown(files), (Size{1, 2}));
}

TEST(TextureBasisu, IsLeftOutWithAWarning) {
  SceneFiles files =
      room(R"({"extensions": {"KHR_texture_basisu": {"source": 1}}})", R"(, "extensionsRequired": ["KHR_texture_basisu"])");
  EXPECT_EQ(import_scene(files, {}).file.warnings, Names{"material 'leaf': texture '0' cannot be read and is left out"});
}

}  // namespace
}  // namespace alvor
