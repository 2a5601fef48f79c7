#include "camera/aravis_camera.hpp"

#include <algorithm>
#include <fstream>

#include "vibe_core/program/error.hpp"

namespace vibe::vision {

void BufferLoan::detach() {
  const std::lock_guard<std::mutex> lock(mutex_);
  stream_ = nullptr;
}

std::shared_ptr<const void> BufferLoan::lend(ArvBuffer* buffer) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (lent_ >= kMost) return nullptr;
    ++lent_;
  }
  return {static_cast<const void*>(buffer),
          [self = shared_from_this(), buffer](const void*) { self->takeBack(buffer); }};
}

void BufferLoan::takeBack(ArvBuffer* buffer) {
  const std::lock_guard<std::mutex> lock(mutex_);
  --lent_;
  if (stream_) {
    arv_stream_push_buffer(stream_, buffer);
  } else {
    g_object_unref(buffer);
  }
}

namespace {

// On the loopback interface test packets of a simulated camera are not answered. With its management data this size
// fills 16 kB of the kernel's memory, so that a frame of 728 x 544 fits in a socket buffer of the default size. [bytes]
constexpr int kLoopbackPacket = 15900;
constexpr guint kInitialPacketTimeout = 2000;  // until a missing packet is asked for [us]
constexpr guint kPacketTimeout = 3000;         // until it is asked for again [us]
constexpr guint kFrameRetention = 10000;       // until an incomplete frame is given up: the next ones wait for it [us]
constexpr int kSocketBuffer = 8 << 20;         // asked of the kernel; net.core.rmem_max limits it [bytes]

std::string textOf(const char* text) {
  return text ? text : "";
}

bool isLoopback(ArvCamera* camera) {
  if (!arv_camera_is_gv_device(camera)) return false;
  GSocketAddress* address = arv_gv_device_get_device_address(ARV_GV_DEVICE(arv_camera_get_device(camera)));
  if (!G_IS_INET_SOCKET_ADDRESS(address)) return false;
  return g_inet_address_get_is_loopback(g_inet_socket_address_get_address(G_INET_SOCKET_ADDRESS(address))) != 0;
}

/// Of a socket buffer, that the kernel grants [bytes]; 0: unknown.
long grantedBuffer() {
  long most = 0;
  std::ifstream("/proc/sys/net/core/rmem_max") >> most;
  return most;
}

bool isAddress(const std::string& name) {
  return g_hostname_is_ip_address(name.c_str()) != 0;
}

}  // namespace

AravisCamera::AravisCamera(const std::string& name, const SourceOptions& options)
    : priority_(options.realtime_priority) {
  connect(name);
  arv_camera_stop_acquisition(camera_.get(), AravisError().slot());  // it may still run for somebody who went
  setFormat(options);
  setRegion(options);
  setTimes(options);
  setPackets(options);
  readFacts();
  start();
}

AravisCamera::~AravisCamera() {
  if (loan_) loan_->detach();
  g_signal_handlers_disconnect_by_data(arv_camera_get_device(camera_.get()), &is_lost_);
  if (!is_lost_) arv_camera_stop_acquisition(camera_.get(), AravisError().slot());
}

void AravisCamera::connect(const std::string& name) {
  AravisError error;
  if (!isAddress(name)) arv_update_device_list();
  camera_.reset(arv_camera_new(name.empty() ? nullptr : name.c_str(), error.slot()));
  if (!camera_) {
    const std::string who = name.empty() ? "no GigE Vision or USB3 Vision camera" : "camera " + name;
    throw Error("gige:" + name + ": " + who + (name.empty() ? " is there" : " does not answer") +
                "; check power, cable and the network address of this computer (arv-tool-0.8 lists cameras)" +
                (error ? ": " + error.text() : ""));
  }
  facts_.name = textOf(arv_camera_get_vendor_name(camera_.get(), error.slot()));
  facts_.name += " " + textOf(arv_camera_get_model_name(camera_.get(), error.slot()));
  facts_.name += " " + textOf(arv_camera_get_device_serial_number(camera_.get(), error.slot()));
  const auto lost = +[](ArvDevice*, gpointer flag) { *static_cast<std::atomic<bool>*>(flag) = true; };
  g_signal_connect(arv_camera_get_device(camera_.get()), "control-lost", G_CALLBACK(lost), &is_lost_);
}

void AravisCamera::note(const AravisError& error, const std::string& wish) {
  if (error) facts_.notes += "; " + wish + " could not be set (" + error.text() + ")";
}

void AravisCamera::setFormat(const SourceOptions& options) {
  AravisError error;
  if (arv_camera_are_chunks_available(camera_.get(), error.slot())) {
    arv_camera_set_chunk_mode(camera_.get(), FALSE, error.slot());
  }
  if (!options.pixel_format.empty()) {
    arv_camera_set_pixel_format_from_string(camera_.get(), options.pixel_format.c_str(), error.slot());
    note(error, "pixel format " + options.pixel_format);
    return;
  }
  arv_camera_set_pixel_format(camera_.get(), ARV_PIXEL_FORMAT_MONO_8, error.slot());  // if it has it
}

void AravisCamera::setRegion(const SourceOptions& options) {
  AravisError error;
  ArvCamera* camera = camera_.get();
  arv_camera_get_sensor_size(camera, &facts_.sensor_width, &facts_.sensor_height, error.slot());
  const int width = options.roi_width > 0 ? options.roi_width : facts_.sensor_width - options.roi_x;
  const int height = options.roi_height > 0 ? options.roi_height : facts_.sensor_height - options.roi_y;
  if (arv_camera_is_region_offset_available(camera, error.slot())) {
    arv_camera_set_region(camera, 0, 0, -1, -1, error.slot());  // offsets limit the size that may be asked for
    arv_camera_set_region(camera, -1, -1, width, height, error.slot());
    if (!error) arv_camera_set_region(camera, options.roi_x, options.roi_y, -1, -1, error.slot());
  } else {
    arv_camera_set_region(camera, -1, -1, width, height, error.slot());
  }
  note(error, "region " + std::to_string(width) + "x" + std::to_string(height) + "+" + std::to_string(options.roi_x) +
                  "+" + std::to_string(options.roi_y));
}

void AravisCamera::setTimes(const SourceOptions& options) {
  AravisError error;
  ArvCamera* camera = camera_.get();
  arv_camera_set_acquisition_mode(camera, ARV_ACQUISITION_MODE_CONTINUOUS, error.slot());
  arv_camera_clear_triggers(camera, error.slot());
  if (arv_camera_is_exposure_auto_available(camera, error.slot())) {
    arv_camera_set_exposure_time_auto(camera, ARV_AUTO_OFF, error.slot());
  }
  arv_camera_set_exposure_time(camera, options.exposure * 1e6, error.slot());
  note(error, "exposure");
  arv_camera_set_frame_rate(camera, options.rate, error.slot());
  note(error, "frame rate");
  if (arv_camera_is_gain_auto_available(camera, error.slot())) {
    arv_camera_set_gain_auto(camera, ARV_AUTO_OFF, error.slot());
  }
  if (options.gain < 0) return;
  arv_camera_set_gain(camera, options.gain, error.slot());
  note(error, "gain");
}

void AravisCamera::setPackets(const SourceOptions& options) {
  ArvCamera* camera = camera_.get();
  if (!arv_camera_is_gv_device(camera)) return;
  // Aravis' packet socket hands packets over in blocks, at the latest after 5 ms; an ordinary socket does so at once
  arv_camera_gv_set_stream_options(camera, ARV_GV_STREAM_OPTION_PACKET_SOCKET_DISABLED);
  AravisError error;
  const int size = options.packet_size > 0 ? options.packet_size : isLoopback(camera) ? kLoopbackPacket : 0;
  if (size > 0) {
    arv_camera_gv_set_packet_size(camera, size, error.slot());
  } else {
    arv_camera_gv_auto_packet_size(camera, error.slot());
  }
  note(error, "packet size");
}

void AravisCamera::readFacts() {
  AravisError error;
  ArvCamera* camera = camera_.get();
  arv_camera_get_region(camera, &facts_.x, &facts_.y, &facts_.width, &facts_.height, error.slot());
  if (error) throw Error(facts_.name + ": its region cannot be read: " + error.text());
  facts_.sensor_width = std::max(facts_.sensor_width, facts_.x + facts_.width);
  facts_.sensor_height = std::max(facts_.sensor_height, facts_.y + facts_.height);
  facts_.exposure = arv_camera_get_exposure_time(camera, error.slot()) * 1e-6;
  if (error)
    throw Error(facts_.name + ": its exposure cannot be read, so that nothing could be stamped: " + error.text());
  facts_.rate = arv_camera_get_frame_rate(camera, error.slot());
  facts_.follows_ptp = followsPtp();
}

bool AravisCamera::followsPtp() {
  AravisError error;
  for (const char* feature : {"PtpStatus", "GevIEEE1588Status"}) {
    if (!arv_camera_is_feature_available(camera_.get(), feature, error.slot())) continue;
    if (textOf(arv_camera_get_string(camera_.get(), feature, error.slot())) == "Slave") return true;
  }
  return false;
}

void AravisCamera::start() {
  AravisError error;
  stream_.reset(arv_camera_create_stream(camera_.get(), &AravisCamera::onStream, this, error.slot()));
  if (!stream_) throw Error(facts_.name + ": no stream: " + error.text() + "; another program may use the camera");
  if (ARV_IS_GV_STREAM(stream_.get())) {
    g_object_set(stream_.get(), "initial-packet-timeout", kInitialPacketTimeout, "packet-timeout", kPacketTimeout,
                 "frame-retention", kFrameRetention, "socket-buffer", ARV_GV_STREAM_SOCKET_BUFFER_FIXED,
                 "socket-buffer-size", kSocketBuffer, nullptr);
  }
  const guint payload = arv_camera_get_payload(camera_.get(), error.slot());
  if (error || payload == 0) throw Error(facts_.name + ": the size of its frames cannot be read: " + error.text());
  for (int i = 0; i < BufferLoan::kBuffers; ++i) {
    arv_stream_push_buffer(stream_.get(), arv_buffer_new(payload, nullptr));
  }
  const long granted = grantedBuffer();
  if (ARV_IS_GV_STREAM(stream_.get()) && granted > 0 && granted < 2L * payload) {
    facts_.notes += "; net.core.rmem_max is " + std::to_string(granted) +
                    " bytes, less than two frames, so that packets may be lost: set it to " +
                    std::to_string(kSocketBuffer) + " (sysctl -w)";
  }
  loan_ = std::make_shared<BufferLoan>(stream_.get());
  arv_camera_start_acquisition(camera_.get(), error.slot());
  if (error) throw Error(facts_.name + ": does not start: " + error.text() + "; another program may use the camera");
}

ArvBuffer* AravisCamera::pop(double timeout) {
  return arv_stream_timeout_pop_buffer(stream_.get(), static_cast<guint64>(std::max(0.0, timeout) * 1e6));
}

void AravisCamera::onStream(void* self, ArvStreamCallbackType type, ArvBuffer*) {
  auto* camera = static_cast<AravisCamera*>(self);
  if (type != ARV_STREAM_CALLBACK_TYPE_INIT || camera->priority_ <= 0) return;
  camera->lacks_priority_ = !arv_make_thread_realtime(camera->priority_);
}

}  // namespace vibe::vision
