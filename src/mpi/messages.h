// Messages between processes: their kinds, header and layout. Leader (leader.h) and Follower
// (follower.h) exchange them through a Post. Headers are in native byte order.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "base/own_file.h"
#include "mpi/post.h"

namespace troffer {

enum class MessageKind : uint32_t {
  // To rank 0:
  want,  // requests `count` more items of job `job`
  // result of item `item` follows and another item is wanted; count: bits of a float, processor
  // seconds
  done,
  ask,   // results of the job have not arrived
  left,  // the process stops working; the reason follows
  halt,  // the process was asked to stop; all should stop
  bye,   // confirms `end`
  // From rank 0:
  lease,   // item `item` is to be done; its input follows
  result,  // piece `item` of `count` of the job's result; to be forwarded
  repeat,  // same, but not to be forwarded
  stop,    // work is to stop
  end,     // last message of the run
  alive
};

struct MessageHeader {
  MessageKind kind{};
  uint32_t count = 0;
  uint64_t job = 0, item = 0;
};
static_assert(sizeof(MessageHeader) == 24);

inline Post::Bytes message(const MessageHeader& header, std::span<const uint8_t> rest = {}) {
  auto bytes = std::make_shared<std::vector<uint8_t>>();
  bytes->reserve(sizeof(header) + rest.size());
  append(*bytes, header);
  bytes->insert(bytes->end(), rest.begin(), rest.end());
  return bytes;
}

inline MessageHeader header_of(const Message& l) {
  return ByteReader(l.bytes).next<MessageHeader>();
}
inline std::span<const uint8_t> rest_of(const Message& l) {
  return std::span(l.bytes).subspan(sizeof(MessageHeader));
}

}  // namespace troffer
