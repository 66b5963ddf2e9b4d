// SPDX-License-Identifier: MIT
/// What all conversations look at: the rows of the run, its models, their meshes. Follows a daemon that ends and starts
/// again under its name.
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
  std::string name;      ///< of the daemon
  std::string file;      ///< a recording instead of a daemon; "": none
  std::string drawings;  ///< socket of a process that draws the models of the recording; "": none
  bool control = false;  ///< pages may change the run
};

/// The triangles of a model, or the reason why there are none.
struct Drawn {
  Message mesh;  ///< in the form in which it goes to a page; see mesh.hpp
  std::string error;
};

class Stage {
 public:
  Stage(boost::asio::io_context& io, StageOptions options);

  /// [main] Opens the recording. A daemon is not opened here: it is looked for again and again.
  Result<void> open();
  void tick();  ///< [main] called 60 times per second while somebody looks

  const StageOptions& options() const { return options_; }
  bool recorded() const { return !options_.file.empty(); }
  const RowSource* rows() const { return rows_.get(); }  ///< nullptr: no daemon has been found yet
  const Json& about() const { return about_; }           ///< parsed once
  uint64_t run() const { return run_; }                  ///< number of runs found so far
  bool alive() const { return recorded() || daemon_->connected(); }
  const Json& list() const { return list_; }            ///< newest answer of `list`
  uint64_t listNumber() const { return list_number_; }  ///< number of its changes so far
  const Json& status() const { return status_; }        ///< newest answer of `status`
  uint64_t statusNumber() const { return status_number_; }
  Daemon& daemon() { return *daemon_; }
  const std::string& socket() const { return socket_; }  ///< of the daemon
  boost::asio::io_context& io() { return io_; }

  /// [main] The triangles of a model, from the cache if it does not deform.
  void draw(const std::string& model, std::function<void(const Drawn&)> drawn);

  /// [main] The vertices that a body of the recording had at the time t [s]; nullptr if they are not available. Not
  /// called if the run has changed by then.
  void drawAt(const std::string& model, double t, std::function<void(const Message&)> drawn);
  std::vector<std::string> bodies() const;  ///< models that deform

  /// The newest vertices of a model that deforms, in the form that goes to a page; frame 0: none yet.
  struct Live {
    uint64_t frame = 0;
    Message vertices;
  };
  const std::map<std::string, Live>& live() const { return live_; }

 private:
  using Clock = std::chrono::steady_clock;
  /// A model that deforms. One whose steps write no vertices is asked for its triangles while it is touched.
  struct Soft {
    uint32_t number = 0;
    bool frames = true;  ///< its steps write vertices
    bool asked = false;  ///< an answer is awaited
    Clock::time_point touched{}, next{};
  };
  void find();
  void adopt(std::unique_ptr<RowSource> rows);
  void poll();
  void pollSoft();
  void askVertices(const std::string& name);
  void askGeometry(const std::string& name);
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
  std::map<std::string, Drawn> meshes_;
  std::map<std::string, Live> live_;
  std::map<std::string, Soft> soft_;
  uint64_t next_contact_ = 0;  ///< row of the stream of contacts
};

}  // namespace hapticd::view
