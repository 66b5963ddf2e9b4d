// SPDX-License-Identifier: MIT
/// The data that all sessions share: the rows of the run, its models and their meshes. If the daemon ends and another
/// one starts with the same name, the stage changes to the new one.
#pragma once
#include <boost/asio/io_context.hpp>
#include <chrono>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "daemon.hpp"
#include "peer.hpp"
#include "row_source.hpp"

namespace hapticd::view {

struct StageOptions {
  std::string folder;    ///< runtime folder of the daemon
  std::string name;      ///< name of the daemon
  std::string file;      ///< a recording to show instead of a daemon, or ""
  std::string drawings;  ///< socket of a process that draws the models of the recording, or ""
  bool control = false;  ///< true if pages may change the run
};

/// A model of the run. Another one may get its name when it has left; `since` tells them apart, as in the answer to
/// `list`.
struct ModelKey {
  std::string name;
  uint64_t since = 0;
  auto operator<=>(const ModelKey&) const = default;
};

/// [any] Returns the key of a model that a request or the list names.
ModelKey keyOf(const Json& request, const char* name);

/// The triangles of a model, or the reason why there are none.
struct DrawnModel {
  Message mesh;  ///< message for pages with the triangles (see mesh.hpp)
  Json facts;    ///< what the daemon said about them: the tolerance and, if it drew coarser, a note
  std::string error;
};

class Stage {
 public:
  Stage(boost::asio::io_context& io, StageOptions options);

  /// [main] Opens the recording. It does not open a daemon: tick() searches for the daemon again and again.
  Result<void> open();
  void tick();  ///< [main] called 60 times per second while a page is open

  const StageOptions& options() const { return options_; }
  bool recorded() const { return !options_.file.empty(); }
  const RowSource* rows() const { return rows_.get(); }  ///< nullptr if no daemon was found yet
  const Json& about() const { return about_; }           ///< description of the run
  uint64_t run() const { return run_; }                  ///< number of runs found so far
  bool alive() const { return recorded() || daemon_->connected(); }
  const Json& list() const { return list_; }            ///< newest answer of `list`
  uint64_t listNumber() const { return list_number_; }  ///< number of changes of list() so far
  const Json& status() const { return status_; }        ///< newest answer of `status`
  uint64_t statusNumber() const { return status_number_; }
  Daemon& daemon() { return *daemon_; }
  const std::string& socket() const { return socket_; }  ///< control socket of the daemon
  boost::asio::io_context& io() { return io_; }

  /// [main] Calls `drawn` with the triangles of a model, which come from the cache if the model does not deform.
  /// @param most largest number of triangles; a body that deforms may have more
  void draw(const ModelKey& model, uint32_t most, std::function<void(const DrawnModel&)> drawn);

  /// [main] Calls `drawn` with the vertices that a body of the recording had at time t [s], or with nullptr if they are
  /// not available. If the run changes before they come, `drawn` is not called.
  void drawAt(const ModelKey& model, double t, std::function<void(const Message&)> drawn);
  std::vector<ModelKey> bodies() const;  ///< models that deform

  /// The newest vertices of a model that deforms, as a message for pages. Frame 0 means that there are none yet.
  struct Live {
    uint64_t frame = 0;
    Message vertices;
  };
  const std::map<ModelKey, Live>& live() const { return live_; }

 private:
  using Clock = std::chrono::steady_clock;
  /// A model that deforms. If its steps write no vertices, its triangles are requested while it is touched.
  struct Soft {
    uint32_t number = 0;
    bool frames = true;  ///< true if its steps write vertices
    bool asked = false;  ///< true if a request was sent and is not yet answered
    Clock::time_point touched{}, next{};
  };
  void find();
  void adopt(std::unique_ptr<RowSource> rows);
  void poll();
  void takeList(const Json& list);
  Json geometryRequest(const ModelKey& model) const;
  void pollSoft();
  void askVertices(const ModelKey& model);
  void askGeometry(const ModelKey& model);
  void findTouched();

  boost::asio::io_context& io_;
  StageOptions options_;
  std::string socket_;
  std::unique_ptr<Daemon> daemon_;
  std::unique_ptr<RowSource> rows_;
  Json about_, list_, status_;
  uint64_t run_ = 0, list_number_ = 0, status_number_ = 0;
  bool was_connected_ = false;
  Clock::time_point next_find_{}, next_poll_{};
  /// The newest drawing of a model, and the largest number of triangles that it was allowed.
  struct CachedDrawing {
    uint32_t most = 0;
    DrawnModel drawn;
  };
  std::map<ModelKey, CachedDrawing> meshes_;
  std::map<ModelKey, Live> live_;
  std::map<ModelKey, Soft> soft_;
  uint64_t next_contact_ = 0;  ///< next row to read of the stream of contacts
};

}  // namespace hapticd::view
