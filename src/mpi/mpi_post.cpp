#include "mpi/mpi_post.h"

#include <mpi.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <list>
#include <thread>

#include "base/error.h"

namespace troffer {

namespace {

using Clock = std::chrono::steady_clock;
using namespace std::chrono_literals;

constexpr int tag = 0;
constexpr size_t large = 4096;          // bytes; larger messages need a handshake in MPI
constexpr auto usual_journey = 1000ms;  // slower messages may be addressed to a dead process
constexpr auto time_to_finish = 10s;

// Sets defaults of Open MPI unless the user chose others. Our messages say when everything is done,
// and Open MPI's own barrier at the end can hang if a process died. Many containers forbid
// single-copy transfers between processes, and then each message would print a line on stderr.
void prepare() {
  setenv("OMPI_MCA_async_mpi_finalize", "1", 0);
  setenv("OMPI_MCA_btl_vader_single_copy_mechanism", "none", 0);
}

enum class Journey { under_way, arrived, lost };

Journey look_at(MPI_Request& request) {
  int flag = 0;
  if (MPI_Test(&request, &flag, MPI_STATUS_IGNORE) != MPI_SUCCESS) return Journey::lost;
  return flag != 0 ? Journey::arrived : Journey::under_way;
}

}  // namespace

struct MpiPost::Moving {
  struct Out {
    Bytes bytes;
    MPI_Request request = MPI_REQUEST_NULL;
    Clock::time_point since;
  };
  struct In {
    Message message;
    MPI_Request request = MPI_REQUEST_NULL;
  };
  std::list<Out> out;
  std::list<In> in;
};

MpiPost::MpiPost(int& argc, char**& argv) : moving_(std::make_unique<Moving>()) {
  prepare();
  int provided = MPI_THREAD_SINGLE;
  MPI_Init_thread(&argc, &argv, MPI_THREAD_SERIALIZED, &provided);
  MPI_Comm_set_errhandler(MPI_COMM_WORLD, MPI_ERRORS_RETURN);
  MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
  MPI_Comm_size(MPI_COMM_WORLD, &size_);
  if (provided < MPI_THREAD_SERIALIZED) {
    MPI_Finalize();
    throw EnvironmentError("this MPI cannot be called from more than one thread");
  }
}

MpiPost::~MpiPost() {
  close(EXIT_FAILURE);
}

// Drops messages to dead processes, which never arrive.
void MpiPost::close(int status) {
  if (is_closed_) return;
  is_closed_ = true;
  for (Moving::Out& o : moving_->out) MPI_Request_free(&o.request);
  for (Moving::In& i : moving_->in) MPI_Cancel(&i.request);
  std::thread([status] {
    std::this_thread::sleep_for(time_to_finish);
    std::fflush(nullptr);
    _exit(status);
  }).detach();
  MPI_Finalize();
}

std::optional<Message> MpiPost::receive() {
  int flag = 0;
  MPI_Message probed = MPI_MESSAGE_NULL;
  MPI_Status status;
  if (MPI_Improbe(MPI_ANY_SOURCE, tag, MPI_COMM_WORLD, &flag, &probed, &status) == MPI_SUCCESS &&
      flag != 0) {
    int size = 0;
    MPI_Get_count(&status, MPI_BYTE, &size);
    Moving::In& in = moving_->in.emplace_back();
    in.message.from = status.MPI_SOURCE;
    in.message.bytes.resize(size_t(size));
    MPI_Imrecv(in.message.bytes.data(), size, MPI_BYTE, &probed, &in.request);
  }
  for (auto in = moving_->in.begin(); in != moving_->in.end();) {
    const Journey journey = look_at(in->request);
    if (journey == Journey::under_way) {
      ++in;
      continue;
    }
    Message arrived = std::move(in->message);
    in = moving_->in.erase(in);
    if (journey == Journey::arrived) return arrived;
  }
  return std::nullopt;
}

void MpiPost::send(int to, Bytes bytes) {
  Moving::Out& out = moving_->out.emplace_back();
  out.bytes = std::move(bytes);
  out.since = Clock::now();
  MPI_Isend(out.bytes->data(), int(out.bytes->size()), MPI_BYTE, to, tag, MPI_COMM_WORLD,
            &out.request);
}

bool MpiPost::is_moving() {
  moving_->out.remove_if([](Moving::Out& o) { return look_at(o.request) != Journey::under_way; });
  const Clock::time_point now = Clock::now();
  return !moving_->in.empty() ||
         std::any_of(moving_->out.begin(), moving_->out.end(), [&](const Moving::Out& o) {
           return o.bytes->size() > large && now - o.since < usual_journey;
         });
}

}  // namespace troffer
