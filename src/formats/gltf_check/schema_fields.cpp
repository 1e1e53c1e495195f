#include "formats/gltf_check/schema_fields.h"

namespace tenebra::formats::schema {
namespace {

constexpr bool required = true;
constexpr Field name_field{"name", Kind::string};
constexpr Field extras_fields[] = {{"casts_shadow", Kind::boolean}};
constexpr Field extras_field{"extras", Kind::object, false, "", 0, extras_fields};

constexpr Field light_extras_fields[] = {
    {"falloff", Kind::string}, {"intensity", Kind::number}, {"diameter_deg", Kind::number}};

constexpr Field asset_fields[] = {{"version", Kind::string, required}, {"minVersion", Kind::string}};
constexpr Field scene_extras_fields[] = {{"ambient_light", Kind::numbers, false, "", 3},
                                         {"background", Kind::numbers, false, "", 3},
                                         {"transfer", Kind::string}};
constexpr Field scene_fields[] = {name_field,
                                  {"extras", Kind::object, false, "", 0, scene_extras_fields},
                                  {"nodes", Kind::refs, false, "nodes"}};
constexpr Field light_link_fields[] = {{"light", Kind::integer, required}};
constexpr Field visibility_fields[] = {{"visible", Kind::boolean}};
constexpr Field instancing_fields[] = {{"attributes", Kind::attributes, required}};
constexpr Field node_extension_fields[] = {
    {"EXT_mesh_gpu_instancing", Kind::object, false, "", 0, instancing_fields},
    {"KHR_lights_punctual", Kind::object, false, "", 0, light_link_fields},
    {"EXT_lights_area", Kind::object, false, "", 0, light_link_fields},
    {"KHR_node_visibility", Kind::object, false, "", 0, visibility_fields}};
constexpr Field node_fields[] = {name_field,
                                 extras_field,
                                 {"camera", Kind::ref, false, "cameras"},
                                 {"children", Kind::refs, false, "nodes"},
                                 {"skin", Kind::ref, false, "skins"},
                                 {"matrix", Kind::numbers, false, "", 16},
                                 {"mesh", Kind::ref, false, "meshes"},
                                 {"rotation", Kind::numbers, false, "", 4},
                                 {"scale", Kind::numbers, false, "", 3},
                                 {"translation", Kind::numbers, false, "", 3},
                                 {"weights", Kind::numbers},
                                 {"extensions", Kind::object, false, "", 0, node_extension_fields}};
constexpr Field draco_fields[] = {{"bufferView", Kind::ref, required, "bufferViews"},
                                  {"attributes", Kind::ids, required}};
constexpr Field primitive_extension_fields[] = {
    {"KHR_draco_mesh_compression", Kind::object, false, "", 0, draco_fields}};
constexpr Field primitive_fields[] = {{"extensions", Kind::object, false, "", 0, primitive_extension_fields},
                                      {"attributes", Kind::attributes, required},
                                      {"indices", Kind::ref, false, "accessors"},
                                      {"material", Kind::ref, false, "materials"},
                                      {"mode", Kind::integer},
                                      {"targets", Kind::targets}};
constexpr Field mesh_fields[] = {name_field,
                                 extras_field,
                                 {"primitives", Kind::objects, required, "", 0, primitive_fields},
                                 {"weights", Kind::numbers}};
constexpr Field sparse_index_fields[] = {{"bufferView", Kind::ref, required, "bufferViews"},
                                         {"byteOffset", Kind::integer},
                                         {"componentType", Kind::integer, required}};
constexpr Field sparse_value_fields[] = {{"bufferView", Kind::ref, required, "bufferViews"},
                                         {"byteOffset", Kind::integer}};
constexpr Field sparse_fields[] = {{"count", Kind::integer, required},
                                   {"indices", Kind::object, required, "", 0, sparse_index_fields},
                                   {"values", Kind::object, required, "", 0, sparse_value_fields}};
constexpr Field accessor_fields[] = {name_field,
                                     {"bufferView", Kind::ref, false, "bufferViews"},
                                     {"byteOffset", Kind::integer},
                                     {"componentType", Kind::integer, required},
                                     {"normalized", Kind::boolean},
                                     {"count", Kind::integer, required},
                                     {"type", Kind::string, required},
                                     {"max", Kind::numbers},
                                     {"min", Kind::numbers},
                                     {"sparse", Kind::object, false, "", 0, sparse_fields}};
constexpr Field compressed_view_fields[] = {{"buffer", Kind::ref, required, "buffers"},
                                            {"byteOffset", Kind::integer},
                                            {"byteLength", Kind::integer, required},
                                            {"byteStride", Kind::integer, required},
                                            {"count", Kind::integer, required},
                                            {"mode", Kind::string, required},
                                            {"filter", Kind::string}};
constexpr Field view_extension_fields[] = {
    {"EXT_meshopt_compression", Kind::object, false, "", 0, compressed_view_fields},
    {"KHR_meshopt_compression", Kind::object, false, "", 0, compressed_view_fields}};
constexpr Field view_fields[] = {{"extensions", Kind::object, false, "", 0, view_extension_fields},
                                 {"buffer", Kind::ref, required, "buffers"},
                                 {"byteOffset", Kind::integer},
                                 {"byteLength", Kind::integer, required},
                                 {"byteStride", Kind::integer},
                                 {"target", Kind::integer}};
constexpr Field fallback_fields[] = {{"fallback", Kind::boolean}};
constexpr Field buffer_extension_fields[] = {
    {"EXT_meshopt_compression", Kind::object, false, "", 0, fallback_fields},
    {"KHR_meshopt_compression", Kind::object, false, "", 0, fallback_fields}};
constexpr Field buffer_fields[] = {{"uri", Kind::string},
                                   {"byteLength", Kind::integer, required},
                                   {"extensions", Kind::object, false, "", 0, buffer_extension_fields}};
constexpr Field transform_fields[] = {{"offset", Kind::numbers, false, "", 2},
                                      {"rotation", Kind::number},
                                      {"scale", Kind::numbers, false, "", 2},
                                      {"texCoord", Kind::integer}};
constexpr Field texture_info_extension_fields[] = {
    {"KHR_texture_transform", Kind::object, false, "", 0, transform_fields}};
constexpr Field texture_info_fields[] = {
    {"index", Kind::ref, required, "textures"},
    {"texCoord", Kind::integer},
    {"extensions", Kind::object, false, "", 0, texture_info_extension_fields}};
constexpr Field material_extras_fields[] = {
    {"casts_shadow", Kind::boolean},
    {"ambient", Kind::numbers, false, "", 3},
    {"base_color", Kind::numbers, false, "", 3},
    {"emissive", Kind::numbers, false, "", 3},
    {"model", Kind::string},
    {"specular", Kind::numbers, false, "", 3},
    {"phong_exponent", Kind::number},
    {"transmission", Kind::number},
    {"specular_texture", Kind::object, false, "", 0, texture_info_fields},
    {"phong_exponent_texture", Kind::object, false, "", 0, texture_info_fields}};
constexpr Field normal_info_fields[] = {
    {"index", Kind::ref, required, "textures"},
    {"texCoord", Kind::integer},
    {"scale", Kind::number},
    {"extensions", Kind::object, false, "", 0, texture_info_extension_fields}};
constexpr Field occlusion_info_fields[] = {
    {"index", Kind::ref, required, "textures"},
    {"texCoord", Kind::integer},
    {"strength", Kind::number},
    {"extensions", Kind::object, false, "", 0, texture_info_extension_fields}};
constexpr Field pbr_fields[] = {
    {"baseColorFactor", Kind::numbers, false, "", 4},
    {"metallicFactor", Kind::number},
    {"roughnessFactor", Kind::number},
    {"baseColorTexture", Kind::object, false, "", 0, texture_info_fields},
    {"metallicRoughnessTexture", Kind::object, false, "", 0, texture_info_fields}};
constexpr Field strength_fields[] = {{"emissiveStrength", Kind::number}};
constexpr Field glossiness_fields[] = {
    {"diffuseFactor", Kind::numbers, false, "", 4},
    {"specularFactor", Kind::numbers, false, "", 3},
    {"glossinessFactor", Kind::number},
    {"diffuseTexture", Kind::object, false, "", 0, texture_info_fields},
    {"specularGlossinessTexture", Kind::object, false, "", 0, texture_info_fields}};
constexpr Field transmission_fields[] = {
    {"transmissionFactor", Kind::number},
    {"transmissionTexture", Kind::object, false, "", 0, texture_info_fields}};
constexpr Field ior_fields[] = {{"ior", Kind::number}};
constexpr Field specular_fields[] = {
    {"specularFactor", Kind::number},
    {"specularColorFactor", Kind::numbers, false, "", 3},
    {"specularTexture", Kind::object, false, "", 0, texture_info_fields},
    {"specularColorTexture", Kind::object, false, "", 0, texture_info_fields}};
constexpr Field material_extension_fields[] = {
    {"KHR_materials_ior", Kind::object, false, "", 0, ior_fields},
    {"KHR_materials_specular", Kind::object, false, "", 0, specular_fields},
    {"KHR_materials_emissive_strength", Kind::object, false, "", 0, strength_fields},
    {"KHR_materials_unlit", Kind::object},
    {"KHR_materials_pbrSpecularGlossiness", Kind::object, false, "", 0, glossiness_fields},
    {"KHR_materials_transmission", Kind::object, false, "", 0, transmission_fields}};
constexpr Field material_fields[] = {name_field,
                                     {"extras", Kind::object, false, "", 0, material_extras_fields},
                                     {"pbrMetallicRoughness", Kind::object, false, "", 0, pbr_fields},
                                     {"normalTexture", Kind::object, false, "", 0, normal_info_fields},
                                     {"occlusionTexture", Kind::object, false, "", 0, occlusion_info_fields},
                                     {"emissiveTexture", Kind::object, false, "", 0, texture_info_fields},
                                     {"emissiveFactor", Kind::numbers, false, "", 3},
                                     {"alphaMode", Kind::string},
                                     {"alphaCutoff", Kind::number},
                                     {"doubleSided", Kind::boolean},
                                     {"extensions", Kind::object, false, "", 0, material_extension_fields}};
constexpr Field perspective_fields[] = {{"aspectRatio", Kind::number},
                                        {"yfov", Kind::number, required},
                                        {"znear", Kind::number, required},
                                        {"zfar", Kind::number}};
constexpr Field orthographic_fields[] = {{"xmag", Kind::number, required},
                                         {"ymag", Kind::number, required},
                                         {"znear", Kind::number, required},
                                         {"zfar", Kind::number, required}};
constexpr Field camera_fields[] = {name_field,
                                   {"type", Kind::string, required},
                                   {"perspective", Kind::object, false, "", 0, perspective_fields},
                                   {"orthographic", Kind::object, false, "", 0, orthographic_fields}};
constexpr Field skin_fields[] = {name_field,
                                 {"inverseBindMatrices", Kind::ref, false, "accessors"},
                                 {"joints", Kind::refs, required, "nodes"},
                                 {"skeleton", Kind::ref, false, "nodes"}};
constexpr Field pointer_fields[] = {{"pointer", Kind::string, required}};
constexpr Field target_extension_fields[] = {
    {"KHR_animation_pointer", Kind::object, false, "", 0, pointer_fields}};
constexpr Field target_fields[] = {{"node", Kind::ref, false, "nodes"},
                                   {"path", Kind::string, required},
                                   {"extensions", Kind::object, false, "", 0, target_extension_fields}};
constexpr Field channel_fields[] = {{"sampler", Kind::integer, required},
                                    {"target", Kind::object, required, "", 0, target_fields}};
constexpr Field sampler_fields[] = {{"input", Kind::ref, required, "accessors"},
                                    {"interpolation", Kind::string},
                                    {"output", Kind::ref, required, "accessors"}};
constexpr Field animation_fields[] = {name_field,
                                      {"channels", Kind::objects, required, "", 0, channel_fields},
                                      {"samplers", Kind::objects, required, "", 0, sampler_fields}};
constexpr Field spot_fields[] = {{"innerConeAngle", Kind::number}, {"outerConeAngle", Kind::number}};
constexpr Field rect_fields[] = {{"aspect", Kind::number}};
constexpr Field light_fields[] = {name_field,
                                  {"extras", Kind::object, false, "", 0, light_extras_fields},
                                  {"type", Kind::string, required},
                                  {"color", Kind::numbers, false, "", 3},
                                  {"intensity", Kind::number},
                                  {"range", Kind::number},
                                  {"size", Kind::number},
                                  {"spot", Kind::object, false, "", 0, spot_fields},
                                  {"rect", Kind::object, false, "", 0, rect_fields}};
constexpr Field lights_fields[] = {{"lights", Kind::objects, required, "", 0, light_fields}};
constexpr Field root_extension_fields[] = {{"KHR_lights_punctual", Kind::object, false, "", 0, lights_fields},
                                           {"EXT_lights_area", Kind::object, false, "", 0, lights_fields}};
constexpr Field source_fields[] = {{"source", Kind::ref, required, "images"}};
constexpr Field texture_extension_fields[] = {
    {"EXT_texture_webp", Kind::object, false, "", 0, source_fields},
    {"KHR_texture_basisu", Kind::object, false, "", 0, source_fields}};
constexpr Field texture_fields[] = {{"source", Kind::ref, false, "images"},
                                    {"sampler", Kind::ref, false, "samplers"},
                                    {"extensions", Kind::object, false, "", 0, texture_extension_fields}};
constexpr Field image_fields[] = {name_field,
                                  {"uri", Kind::string},
                                  {"mimeType", Kind::string},
                                  {"bufferView", Kind::ref, false, "bufferViews"}};
constexpr Field texture_sampler_fields[] = {{"magFilter", Kind::integer},
                                            {"minFilter", Kind::integer},
                                            {"wrapS", Kind::integer},
                                            {"wrapT", Kind::integer}};
constexpr Field all_fields[] = {{"asset", Kind::object, required, "", 0, asset_fields},
                                {"extensionsUsed", Kind::strings},
                                {"extensionsRequired", Kind::strings},
                                {"scene", Kind::ref, false, "scenes"},
                                {"scenes", Kind::objects, false, "", 0, scene_fields},
                                {"nodes", Kind::objects, false, "", 0, node_fields},
                                {"meshes", Kind::objects, false, "", 0, mesh_fields},
                                {"accessors", Kind::objects, false, "", 0, accessor_fields},
                                {"bufferViews", Kind::objects, false, "", 0, view_fields},
                                {"buffers", Kind::objects, false, "", 0, buffer_fields},
                                {"materials", Kind::objects, false, "", 0, material_fields},
                                {"cameras", Kind::objects, false, "", 0, camera_fields},
                                {"skins", Kind::objects, false, "", 0, skin_fields},
                                {"animations", Kind::objects, false, "", 0, animation_fields},
                                {"textures", Kind::objects, false, "", 0, texture_fields},
                                {"images", Kind::objects, false, "", 0, image_fields},
                                {"samplers", Kind::objects, false, "", 0, texture_sampler_fields},
                                {"extensions", Kind::object, false, "", 0, root_extension_fields}};

}  // namespace

std::span<const Field> root_fields() {
  return all_fields;
}

}  // namespace tenebra::formats::schema
