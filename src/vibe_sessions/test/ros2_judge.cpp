// What ROS 2 finds in messages: reads lines `PACKAGE NAME CDR` with hexadecimal bytes, and writes lines `CDR CONTENT`
// with the bytes of the message that it made of them and its fields as JSON, in lists. Fields are walked by the
// introspection that rosidl has generated, values are read and written by Fast CDR.
#include <dlfcn.h>
#include <fastcdr/Cdr.h>

#include <cstdio>
#include <iostream>
#include <rosidl_typesupport_introspection_cpp/field_types.hpp>
#include <rosidl_typesupport_introspection_cpp/message_introspection.hpp>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

using eprosima::fastcdr::Cdr;
using eprosima::fastcdr::FastBuffer;
using namespace rosidl_typesupport_introspection_cpp;

const MessageMembers& membersOf(const rosidl_message_type_support_t* support) {
  return *static_cast<const MessageMembers*>(support->data);
}

/// Throws std::runtime_error where nothing was generated for this type.
const MessageMembers& membersOf(const std::string& package, const std::string& name) {
  void* library = dlopen(("lib" + package + "__rosidl_typesupport_introspection_cpp.so").c_str(), RTLD_NOW);
  const std::string symbol =
      "rosidl_typesupport_introspection_cpp__get_message_type_support_handle__" + package + "__msg__" + name;
  void* found = library != nullptr ? dlsym(library, symbol.c_str()) : nullptr;
  if (found == nullptr) throw std::runtime_error(dlerror());
  return membersOf(reinterpret_cast<const rosidl_message_type_support_t* (*)()>(found)());
}

/// Calls a visitor with the type of the member in C++ and a pointer to nothing of it.
template <class Visitor>
void withType(const MessageMember& member, Visitor visit) {
  switch (member.type_id_) {
    case ROS_TYPE_BOOLEAN:
      return visit(bool());
    case ROS_TYPE_OCTET:
    case ROS_TYPE_UINT8:
    case ROS_TYPE_CHAR:
      return visit(std::uint8_t());
    case ROS_TYPE_INT8:
      return visit(std::int8_t());
    case ROS_TYPE_UINT16:
      return visit(std::uint16_t());
    case ROS_TYPE_INT16:
      return visit(std::int16_t());
    case ROS_TYPE_UINT32:
      return visit(std::uint32_t());
    case ROS_TYPE_INT32:
      return visit(std::int32_t());
    case ROS_TYPE_UINT64:
      return visit(std::uint64_t());
    case ROS_TYPE_INT64:
      return visit(std::int64_t());
    case ROS_TYPE_FLOAT:
      return visit(float());
    case ROS_TYPE_DOUBLE:
      return visit(double());
    case ROS_TYPE_STRING:
      return visit(std::string());
    default:
      throw std::runtime_error(std::string(member.name_) + " is of a type that ROS 1 does not have");
  }
}

bool isCounted(const MessageMember& member) {
  return member.is_array_ && (member.array_size_ == 0 || member.is_upper_bound_);
}

void readMessage(Cdr& cdr, const MessageMembers& type, char* message) {
  for (std::uint32_t k = 0; k < type.member_count_; ++k) {
    const MessageMember& member = type.members_[k];
    char* field = message + member.offset_;
    std::uint32_t count = static_cast<std::uint32_t>(member.array_size_);
    if (isCounted(member)) {
      cdr >> count;
      member.resize_function(field, count);
    }
    for (std::uint32_t i = 0; i < (member.is_array_ ? count : 1); ++i)
      if (member.type_id_ == ROS_TYPE_MESSAGE)
        readMessage(cdr, membersOf(member.members_),
                    member.is_array_ ? static_cast<char*>(member.get_function(field, i)) : field);
      else
        withType(member, [&](auto value) {
          cdr >> value;
          if (member.is_array_)
            member.assign_function(field, i, &value);
          else
            *reinterpret_cast<decltype(value)*>(field) = value;
        });
  }
}

std::string asJson(const std::string& text) {
  std::string said = "\"";
  for (const char c : text)
    if (c == '"' || c == '\\')
      said += {'\\', c};
    else if (c == '\n')
      said += "\\n";
    else
      said += c;
  return said + '"';
}

std::string asJson(bool value) {
  return value ? "true" : "false";
}

std::string asJson(double value) {
  if (value != value) return "NaN";
  if (value - value != 0) return value > 0 ? "Infinity" : "-Infinity";
  char said[32];
  std::snprintf(said, sizeof said, "%.17e", value);
  return said;
}

std::string asJson(float value) {
  return asJson(static_cast<double>(value));
}

template <class Integer>
std::string asJson(Integer value) {
  return std::to_string(value);
}

/// Writes a message to `cdr` and returns its content.
std::string writeMessage(Cdr& cdr, const MessageMembers& type, const char* message) {
  std::string content;
  for (std::uint32_t k = 0; k < type.member_count_; ++k) {
    const MessageMember& member = type.members_[k];
    const char* field = message + member.offset_;
    const std::size_t count = member.is_array_ ? member.size_function(field) : 1;
    if (isCounted(member)) cdr << static_cast<std::uint32_t>(count);
    std::string values;
    for (std::size_t i = 0; i < count; ++i) {
      if (i > 0) values += ", ";
      if (member.type_id_ == ROS_TYPE_MESSAGE)
        values +=
            writeMessage(cdr, membersOf(member.members_),
                         member.is_array_ ? static_cast<const char*>(member.get_const_function(field, i)) : field);
      else
        withType(member, [&](auto value) {
          if (member.is_array_)
            member.fetch_function(field, i, &value);
          else
            value = *reinterpret_cast<const decltype(value)*>(field);
          cdr << value;
          values += asJson(value);
        });
    }
    if (std::string(member.name_) == "structure_needs_at_least_one_member") continue;  // of a message without fields
    content += (content.empty() ? "" : ", ") + (member.is_array_ ? "[" + values + "]" : values);
  }
  return "[" + content + "]";
}

std::vector<char> bytesOf(const std::string& text) {
  std::vector<char> bytes;
  for (std::size_t k = 0; k + 1 < text.size(); k += 2)
    bytes.push_back(static_cast<char>(std::stoi(text.substr(k, 2), nullptr, 16)));
  return bytes;
}

std::string judge(const MessageMembers& type, std::vector<char> bytes) {
  std::vector<char> message(type.size_of_);
  type.init_function(message.data(), rosidl_runtime_cpp::MessageInitialization::ALL);
  std::vector<char> room(bytes.size() + 8);  // of zeros, since Fast CDR leaves gaps as they are
  FastBuffer given(bytes.data(), bytes.size()), made(room.data(), room.size());
  Cdr reader(given, Cdr::DEFAULT_ENDIAN, Cdr::DDS_CDR), writer(made, Cdr::DEFAULT_ENDIAN, Cdr::DDS_CDR);
  reader.read_encapsulation();
  readMessage(reader, type, message.data());
  writer.serialize_encapsulation();
  const std::string content = writeMessage(writer, type, message.data());
  type.fini_function(message.data());
  std::string said;
  char digits[3];
  for (std::size_t k = 0; k < writer.getSerializedDataLength(); ++k) {
    std::snprintf(digits, sizeof digits, "%02x", static_cast<unsigned char>(room[k]));
    said += digits;
  }
  return said + " " + content;
}

}  // namespace

int main() {
  std::string package, name, bytes;
  try {
    while (std::cin >> package >> name >> bytes) std::cout << judge(membersOf(package, name), bytesOf(bytes)) << '\n';
  } catch (const std::exception& error) {
    std::cerr << package << '/' << name << ": " << error.what() << '\n';
    return 1;
  }
}
