#include "ply_format.hpp"

#include <bit>
#include <cstdint>
#include <cstring>
#include <vector>

#include "mesh_text.hpp"

namespace fleetmap::sim {
namespace {

static_assert(std::endian::native == std::endian::little, "files are read in the machine's byte order");

enum class Scalar : std::uint8_t { kI8, kU8, kI16, kU16, kI32, kU32, kF32, kF64 };

std::optional<Scalar> scalar_named(std::string_view name) {
  if (name == "char" || name == "int8") return Scalar::kI8;
  if (name == "uchar" || name == "uint8") return Scalar::kU8;
  if (name == "short" || name == "int16") return Scalar::kI16;
  if (name == "ushort" || name == "uint16") return Scalar::kU16;
  if (name == "int" || name == "int32") return Scalar::kI32;
  if (name == "uint" || name == "uint32") return Scalar::kU32;
  if (name == "float" || name == "float32") return Scalar::kF32;
  if (name == "double" || name == "float64") return Scalar::kF64;
  return std::nullopt;
}

std::size_t size_of(Scalar scalar) {
  switch (scalar) {
    case Scalar::kI8:
    case Scalar::kU8:
      return 1;
    case Scalar::kI16:
    case Scalar::kU16:
      return 2;
    case Scalar::kF64:
      return 8;
    default:
      return 4;
  }
}

struct Property {
  std::string name;
  Scalar type = Scalar::kF32;
  std::optional<Scalar> list_size;  ///< of a list: the type of its length
};

struct Element {
  std::string name;
  std::uint64_t count = 0;
  std::size_t line = 0;
  std::vector<Property> properties;
};

struct Header {
  bool ascii = false;
  std::vector<Element> elements;
  std::string_view body;
  std::size_t lines = 0;
};

Status read_format(std::string_view line, std::size_t number, Header& header) {
  const std::string_view format = next_word(line);
  header.ascii = format == "ascii";
  if (header.ascii || format == "binary_little_endian") return {};
  return failure_at_line(
      number,
      in_quotes(format) + " is no format that is read; save the mesh as ascii or binary_little_endian");
}

Status read_element(std::string_view line, std::size_t number, Header& header) {
  Element element;
  element.name = next_word(line);
  element.line = number;
  const std::string_view word = next_word(line);
  const auto count = number_from<std::uint64_t>(word);
  if (!count)
    return failure_at_line(number,
                           in_quotes(word) + " is no count of " + element.name + "; export the mesh again");
  element.count = *count;
  header.elements.push_back(std::move(element));
  return {};
}

Status read_property(std::string_view line, std::size_t number, Header& header) {
  Property property;
  std::string_view type = next_word(line);
  const bool list = type == "list";
  if (list) {
    property.list_size = scalar_named(next_word(line));
    type = next_word(line);
  }
  const auto scalar = scalar_named(type);
  property.name = next_word(line);
  const bool whole_size = !list || (property.list_size && *property.list_size != Scalar::kF32 &&
                                    *property.list_size != Scalar::kF64);
  if (!scalar || !whole_size || property.name.empty() || header.elements.empty())
    return failure_at_line(number, "not a property of an element; export the mesh again");
  property.type = *scalar;
  header.elements.back().properties.push_back(std::move(property));
  return {};
}

Result<Header> read_header(std::string_view content) {
  Header header;
  Lines lines(content);
  std::string_view line;
  if (!lines.next(line) || line != "ply")
    return failure_at_line(1, "the first line must be 'ply'; give a PLY mesh");
  bool format = false;
  while (lines.next(line)) {
    const std::string_view key = next_word(line);
    Status status;
    if (key == "format") {
      status = read_format(line, lines.number(), header);
      format = true;
    } else if (key == "element") {
      status = read_element(line, lines.number(), header);
    } else if (key == "property") {
      status = read_property(line, lines.number(), header);
    } else if (key == "end_header") {
      if (!format)
        return failure_at_line(lines.number(), "the header names no format; export the mesh again");
      header.body = lines.rest();
      header.lines = lines.number();
      return header;
    } else if (key != "comment" && key != "obj_info" && !key.empty()) {
      return failure_at_line(lines.number(),
                             in_quotes(key) + " is no word of a header; export the mesh again");
    }
    if (!status) return tl::unexpected(status.error());
  }
  return failure_at_line(lines.number(), "the header has no end_header; the file is cut off, copy it again");
}

/// The body's numbers one after the other, whatever their encoding.
class Body {
 public:
  Body(const Header& header, std::size_t offset)
      : ascii_(header.ascii),
        lines_(header.body),
        first_line_(header.lines),
        rest_(header.body),
        offset_(offset),
        size_(header.body.size()) {}

  bool take(Scalar type, double& value) { return ascii_ ? take_word(value) : take_bytes(type, value); }
  std::size_t left() const { return ascii_ ? lines_.rest().size() + words_.size() : rest_.size(); }
  tl::unexpected<Error> failure_here(const std::string& what) const {
    if (ascii_) return failure_at_line(first_line_ + lines_.number(), what);
    return failure_at_byte(offset_ + size_ - rest_.size(), what);
  }

 private:
  bool take_word(double& value) {
    std::string_view word = next_word(words_);
    while (word.empty() && lines_.next(words_)) word = next_word(words_);
    const auto number = number_from<double>(word);
    if (number) value = *number;
    return number.has_value();
  }

  template <class T>
  double as() const {
    T value{};
    std::memcpy(&value, rest_.data(), sizeof value);
    return static_cast<double>(value);
  }

  bool take_bytes(Scalar type, double& value) {
    const std::size_t size = size_of(type);
    if (rest_.size() < size) return false;
    switch (type) {
      case Scalar::kI8:
        value = as<std::int8_t>();
        break;
      case Scalar::kU8:
        value = as<std::uint8_t>();
        break;
      case Scalar::kI16:
        value = as<std::int16_t>();
        break;
      case Scalar::kU16:
        value = as<std::uint16_t>();
        break;
      case Scalar::kI32:
        value = as<std::int32_t>();
        break;
      case Scalar::kU32:
        value = as<std::uint32_t>();
        break;
      case Scalar::kF32:
        value = as<float>();
        break;
      case Scalar::kF64:
        value = as<double>();
        break;
    }
    rest_.remove_prefix(size);
    return true;
  }

  bool ascii_;
  Lines lines_;
  std::string_view words_;
  std::size_t first_line_;
  std::string_view rest_;
  std::size_t offset_, size_;
};

std::string numbered(const char* what, std::uint64_t number) {
  std::string text = what;
  return text.append(std::to_string(number));
}

constexpr const char* kCutOff = "the file ends early or holds what is no number; copy or export it again";

/// Reads one element's values: single ones to `single(name, value)`, lists to `list(name, values)`.
template <class Single, class List>
Status read_values(const Element& element, Body& body, std::vector<double>& values, Single&& single,
                   List&& list) {
  for (const Property& property : element.properties) {
    double value = 0.0;
    if (!body.take(property.list_size.value_or(property.type), value)) return body.failure_here(kCutOff);
    if (!property.list_size) {
      single(property.name, value);
      continue;
    }
    if (!(value >= 0.0) || value > static_cast<double>(body.left()))
      return body.failure_here("a list is longer than the file; export the mesh again");
    values.resize(static_cast<std::size_t>(value));
    for (double& entry : values) {
      if (!body.take(property.type, entry)) return body.failure_here(kCutOff);
    }
    list(property.name, values);
  }
  return {};
}

Status read_vertices(const Element& element, Body& body, Mesh& mesh) {
  std::vector<double> scratch;
  for (std::uint64_t k = 0; k < element.count; ++k) {
    Eigen::Vector3d p = Eigen::Vector3d::Constant(std::nan(""));
    const Status status = read_values(
        element, body, scratch,
        [&p](const std::string& name, double value) {
          if (name == "x") p.x() = value;
          if (name == "y") p.y() = value;
          if (name == "z") p.z() = value;
        },
        [](const std::string&, const std::vector<double>&) {});
    if (!status) return status;
    if (!is_coordinate(p.x()) || !is_coordinate(p.y()) || !is_coordinate(p.z()))
      return body.failure_here(numbered("vertex ", k) + ": " + kCoordinateRule);
    mesh.vertices.emplace_back(p.cast<float>());
  }
  return {};
}

Status read_faces(const Element& element, Body& body, Mesh& mesh) {
  std::vector<double> scratch, corners;
  for (std::uint64_t k = 0; k < element.count; ++k) {
    Material material = Material::kConcrete;
    corners.clear();
    const Status status = read_values(
        element, body, scratch,
        [&material](const std::string& name, double value) {
          if (name == "material" && value >= 0.0 && value < kMaterials)
            material = static_cast<Material>(static_cast<int>(value));
        },
        [&corners](const std::string& name, const std::vector<double>& values) {
          if (name == "vertex_indices" || name == "vertex_index") corners = values;
        });
    if (!status) return status;
    if (corners.size() < 3)
      return body.failure_here(numbered("face ", k) + " has fewer than three corners; export the mesh again");
    for (const double corner : corners) {
      if (!(corner >= 0.0 && corner < static_cast<double>(mesh.vertices.size())))
        return body.failure_here(numbered("face ", k) + " names none of the " +
                                 std::to_string(mesh.vertices.size()) + " vertices; export the mesh again");
    }
    const auto index = [&corners](std::size_t c) { return static_cast<std::uint32_t>(corners[c]); };
    for (std::size_t c = 2; c < corners.size(); ++c)
      add_fan(mesh, index(0), index(c - 1), index(c), material);
  }
  return {};
}

Status skip(const Element& element, Body& body) {
  std::vector<double> scratch;
  for (std::uint64_t k = 0; k < element.count; ++k) {
    const Status status = read_values(
        element, body, scratch, [](const std::string&, double) {},
        [](const std::string&, const std::vector<double>&) {});
    if (!status) return status;
  }
  return {};
}

/// The header's counts are bounded by the file's length.
Status plausible(const Element& element, const Header& header) {
  std::size_t smallest = 0;
  for (const Property& property : element.properties)
    smallest += header.ascii ? 2 : size_of(property.list_size.value_or(property.type));
  if (element.count == 0 || (smallest > 0 && element.count <= (header.body.size() + 1) / smallest)) return {};
  return failure_at_line(element.line, std::to_string(element.count) + " of " + in_quotes(element.name) +
                                           " do not fit into this file; it is cut off or damaged, copy or "
                                           "export it again");
}

}  // namespace

Result<Mesh> parse_ply(std::string_view content) {
  const Result<Header> header = read_header(content);
  if (!header) return tl::unexpected(header.error());
  Body body(*header, content.size() - header->body.size());
  Mesh mesh;
  for (const Element& element : header->elements) {
    Status status = plausible(element, *header);
    if (status && element.name == "vertex") {
      status = read_vertices(element, body, mesh);
    } else if (status && element.name == "face") {
      status = read_faces(element, body, mesh);
    } else if (status) {
      status = skip(element, body);
    }
    if (!status) return tl::unexpected(status.error());
  }
  return mesh;
}

}  // namespace fleetmap::sim
