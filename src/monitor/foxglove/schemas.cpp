#include "schemas.hpp"

namespace fleetmap::monitor::foxglove {
namespace {

const std::string kTime = R"(
  struct Time { uint32 sec; uint32 nsec; };
)";

const std::string kTransform = R"(
  struct Vector3 { double x; double y; double z; };
  struct Quaternion { double x; double y; double z; double w; };
)";

const std::string kPose = R"(
  struct Pose { Vector3 position; Quaternion orientation; };
)";

const std::string kFrameTransforms = R"(
  struct FrameTransform {
    Time timestamp;
    string parent_frame_id;
    string child_frame_id;
    Vector3 translation;
    Quaternion rotation;
  };
  struct FrameTransforms { sequence<FrameTransform> transforms; };
)";

const std::string kPointCloud = R"(
  enum NumericType { UNKNOWN, UINT8, INT8, UINT16, INT16, UINT32, INT32, FLOAT32, FLOAT64 };
  struct PackedElementField { string name; uint32 offset; NumericType type; };
  struct PointCloud {
    Time timestamp;
    string frame_id;
    Pose pose;
    uint32 point_stride;
    sequence<PackedElementField> fields;
    sequence<uint8> data;
  };
)";

const std::string kPrimitives = R"(
  struct Color { double r; double g; double b; double a; };
  struct Point3 { double x; double y; double z; };
  struct ArrowPrimitive {
    Pose pose;
    double shaft_length;
    double shaft_diameter;
    double head_length;
    double head_diameter;
    Color color;
  };
  struct CubePrimitive { Pose pose; Vector3 size; Color color; };
  struct SpherePrimitive { Pose pose; Vector3 size; Color color; };
  struct CylinderPrimitive { Pose pose; Vector3 size; double bottom_scale; double top_scale; Color color; };
  enum LineType { LINE_STRIP, LINE_LOOP, LINE_LIST };
  struct LinePrimitive {
    LineType type;
    Pose pose;
    double thickness;
    boolean scale_invariant;
    sequence<Point3> points;
    Color color;
    sequence<Color> colors;
    sequence<uint32> indices;
  };
  struct TriangleListPrimitive {
    Pose pose;
    sequence<Point3> points;
    Color color;
    sequence<Color> colors;
    sequence<uint32> indices;
  };
  struct TextPrimitive {
    Pose pose;
    boolean billboard;
    double font_size;
    boolean scale_invariant;
    Color color;
    string text;
  };
  struct ModelPrimitive {
    Pose pose;
    Vector3 scale;
    Color color;
    boolean override_color;
    string url;
    string media_type;
    sequence<uint8> data;
  };
)";

const std::string kSceneUpdate = R"(
  struct Duration { int32 sec; uint32 nsec; };
  struct KeyValuePair { string key; string value; };
  struct SceneEntity {
    Time timestamp;
    string frame_id;
    string id;
    Duration lifetime;
    boolean frame_locked;
    sequence<KeyValuePair> metadata;
    sequence<ArrowPrimitive> arrows;
    sequence<CubePrimitive> cubes;
    sequence<SpherePrimitive> spheres;
    sequence<CylinderPrimitive> cylinders;
    sequence<LinePrimitive> lines;
    sequence<TriangleListPrimitive> triangles;
    sequence<TextPrimitive> texts;
    sequence<ModelPrimitive> models;
  };
  enum SceneEntityDeletionType { MATCHING_ID, ALL };
  struct SceneEntityDeletion { Time timestamp; SceneEntityDeletionType type; string id; };
  struct SceneUpdate { sequence<SceneEntityDeletion> deletions; sequence<SceneEntity> entities; };
)";

const std::string kLocationFix = R"(
  enum PositionCovarianceType { UNKNOWN, APPROXIMATED, DIAGONAL_KNOWN, KNOWN };
  struct LocationFix {
    Time timestamp;
    string frame_id;
    double latitude;
    double longitude;
    double altitude;
    double position_covariance[9];
    PositionCovarianceType position_covariance_type;
  };
)";

// A number that is not known is NaN.
const std::string kRobotStatus = R"(
  struct LastHeard {
    string link;         // long_range or short_range
    double seconds_ago;
  };
  struct RobotStatus {
    string robot;
    string activity;
    sequence<string> problems;
    sequence<LastHeard> heard;
    double battery;      // share left; NaN: unknown
    double sigma_m;      // m, horizontal, of its own global pose; NaN: unknown
    uint32 nodes;        // held
    uint32 alignments;   // held
    uint32 submaps;      // held
    uint32 backlog_bytes;
    boolean ordered_to_hold;
    boolean called_home;  // also while it is ordered to hold
    boolean driven;
  };
)";

std::string module(const std::string& name, const std::string& types) {
  return "module " + name + " {" + types + "};\n";
}

}  // namespace

const Schema& schema_of(ChannelKind kind) {
  static const Schema transforms{"foxglove::FrameTransforms",
                                 module("foxglove", kTime + kTransform + kFrameTransforms)};
  static const Schema scene{"foxglove::SceneUpdate",
                            module("foxglove", kTime + kTransform + kPose + kPrimitives + kSceneUpdate)};
  static const Schema map{"foxglove::PointCloud",
                          module("foxglove", kTime + kTransform + kPose + kPointCloud)};
  static const Schema fix{"foxglove::LocationFix", module("foxglove", kTime + kLocationFix)};
  static const Schema status{"fleetmap::RobotStatus", module("fleetmap", kRobotStatus)};
  switch (kind) {
    case ChannelKind::transforms:
      return transforms;
    case ChannelKind::trajectories:
    case ChannelKind::alignments:
      return scene;
    case ChannelKind::map:
      return map;
    case ChannelKind::fix:
      return fix;
    case ChannelKind::status:
      return status;
  }
  return status;
}

}  // namespace fleetmap::monitor::foxglove
