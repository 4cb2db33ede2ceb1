#include "grn_argos.h"

#include <argos3/core/utility/configuration/argos_exception.h>

#include <cmath>
#include <fstream>
#include <iterator>
#include <string>

using namespace argos;

namespace {

void Check(GrnStatus status) {
    if (status != GRN_STATUS_OK) THROW_ARGOSEXCEPTION("grn: " << grn_status_text(status));
}

std::int16_t Millimetres(Real metres) {
    return static_cast<std::int16_t>(std::lround(metres * 1e3));
}

GrnMillimetres Place(const CVector2& metres) {
    GrnMillimetres place;
    place.x = Millimetres(metres.GetX());
    place.y = Millimetres(metres.GetY());
    return place;
}

// The plugin's curve, 197.9 d^2 - 30.5 d + 1.01 of the reading at touch with d in metres, backwards; in 0.1 mm.
std::uint16_t FreeDistance(Real share) {
    const Real a = 197.9, b = -30.5, c = 1.01 - share;
    if (share >= 1.0) return 0;
    const Real under = b * b - 4.0 * a * c;
    // Below its lowest point, 7.7 cm away, the curve tells nothing.
    if (under < 0.0) return UINT16_MAX;
    const Real metres = (-b - std::sqrt(under)) / (2.0 * a);
    return metres > 0.05 ? UINT16_MAX : static_cast<std::uint16_t>(std::lround(std::fmax(metres, 0.0) * 1e4));
}

}  // namespace

void CGrnController::Init(TConfigurationNode& node) {
    m_wheels = GetActuator<CCI_DifferentialSteeringActuator>("differential_steering");
    m_proximity = GetSensor<CCI_EPuck2ProximitySensor>("epuck2_proximity");
    m_positioning = GetSensor<CCI_PositioningSensor>("positioning");
    m_sender = GetActuator<CCI_RangeAndBearingActuator>("range_and_bearing");
    m_receiver = GetSensor<CCI_RangeAndBearingSensor>("range_and_bearing");
    std::string path;
    GetNodeAttribute(node, "blob", path);
    GetNodeAttribute(node, "robot", m_robot);
    GetNodeAttributeOrDefault(node, "tick", m_tick, m_tick);
    GetNodeAttributeOrDefault(node, "packet", m_packet, m_packet);
    GetNodeAttributeOrDefault(node, "touching", m_touching, m_touching);
    if (m_robot > UINT16_MAX) THROW_ARGOSEXCEPTION("grn: robot=\"" << m_robot << "\": must be at most 65535");
    if (m_packet < 1 + GRN_MIN_PAYLOAD_BYTES) THROW_ARGOSEXCEPTION("grn: packet=\"" << m_packet << "\": must be at least 3");
    std::ifstream file(path.c_str(), std::ios::binary);
    if (!file) THROW_ARGOSEXCEPTION("grn: blob=\"" << path << "\": cannot be opened");
    m_blob.assign(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>());
    Load();
}

void CGrnController::Load() {
    const std::uint16_t robot = static_cast<std::uint16_t>(m_robot);
    Check(grn_load(&m_controller, sizeof m_controller, m_blob.data(), m_blob.size(), GRN_NUMBER_F32, robot));
    Check(grn_percept_nothing(&m_percept));
    m_assembler = GrnAssembler();
    m_waiting.clear();
    m_time = 0;
}

void CGrnController::Reset() {
    Load();
}

void CGrnController::SeeTarget(std::uint8_t target, const CVector2& place) {
    if (m_percept.target_count == GRN_MAX_TARGETS) return;
    GrnSighting& sighting = m_percept.targets[m_percept.target_count++];
    sighting.target = target;
    sighting.position = Place(place);
}

void CGrnController::SeeObstacle(const CVector2& point) {
    if (m_percept.obstacle_count == GRN_MAX_SEEN_OBSTACLES) return;
    m_percept.obstacles[m_percept.obstacle_count++] = Place(point);
}

void CGrnController::ControlStep() {
    Sense();
    Hear();
    GrnCommand command;
    Check(grn_tick(&m_controller, &m_percept, &command));
    // Centimetres per second: docs/units.md.
    m_wheels->SetLinearVelocity(command.left * 0.0128805, command.right * 0.0128805);
    if (command.has_broadcast) Say(command.broadcast);
    SendNext();
    Check(grn_percept_nothing(&m_percept));
    m_time++;
}

void CGrnController::Sense() {
    const CCI_PositioningSensor::SReading& pose = m_positioning->GetReading();
    CRadians yaw, pitch, roll;
    pose.Orientation.ToEulerAngles(yaw, pitch, roll);
    m_percept.elapsed_us = static_cast<std::uint32_t>(std::lround(m_tick * 1e6));
    m_percept.has_fix = 1;
    m_percept.fix.position[0] = static_cast<std::int32_t>(std::lround(pose.Position.GetX() * 1e6));
    m_percept.fix.position[1] = static_cast<std::int32_t>(std::lround(pose.Position.GetY() * 1e6));
    m_percept.fix.heading[0] = static_cast<std::int16_t>(std::lround(std::cos(yaw.GetValue()) * 16384));
    m_percept.fix.heading[1] = static_cast<std::int16_t>(std::lround(std::sin(yaw.GetValue()) * 16384));
    const CCI_EPuck2ProximitySensor::TReadings& readings = m_proximity->GetReadings();
    for (std::size_t i = 0; i < readings.size() && i < GRN_PROXIMITY_SENSORS; i++) {
        m_percept.proximity[i] = FreeDistance(readings[i].Value / m_touching);
    }
}

void CGrnController::Hear() {
    Real ranges[GRN_MAX_HEARD];
    for (const CCI_RangeAndBearingSensor::SPacket& packet : m_receiver->GetReadings()) {
        std::vector<std::uint8_t> bytes(packet.Data.Size());
        for (std::size_t i = 0; i < bytes.size(); i++) bytes[i] = packet.Data[i];
        // Boards send what they have in every step, so most of what comes is empty.
        if (bytes.empty() || bytes[0] == 0 || bytes[0] >= bytes.size()) continue;
        GrnMessage message;
        if (grn_assembler_receive(&m_assembler, sizeof m_assembler, m_time, bytes.data() + 1, bytes[0], &message) !=
            GRN_STATUS_OK) {
            continue;
        }
        std::size_t place = m_percept.heard_count;
        if (place == GRN_MAX_HEARD) {
            place = 0;
            for (std::size_t i = 1; i < GRN_MAX_HEARD; i++) place = ranges[i] > ranges[place] ? i : place;
            if (packet.Range >= ranges[place]) continue;
        } else {
            m_percept.heard_count++;
        }
        m_percept.heard[place].message = message;
        m_percept.heard[place].age_ms = static_cast<std::uint16_t>(std::lround(m_tick * 1e3));
        ranges[place] = packet.Range;
    }
}

void CGrnController::Say(const GrnMessage& message) {
    m_message++;
    std::size_t length = 1;
    for (std::size_t index = 0; length > 0; index++) {
        std::uint8_t fragment[GRN_MAX_FRAGMENT_BYTES];
        Check(grn_message_fragment(&message, m_message, m_packet - 1, index, fragment, &length));
        if (length > 0) m_waiting.emplace_back(fragment, fragment + length);
    }
}

void CGrnController::SendNext() {
    CByteArray data(m_packet);
    if (!m_waiting.empty()) {
        const std::vector<std::uint8_t>& fragment = m_waiting.front();
        data[0] = static_cast<UInt8>(fragment.size());
        for (std::size_t i = 0; i < fragment.size(); i++) data[i + 1] = fragment[i];
        m_waiting.erase(m_waiting.begin());
    }
    m_sender->SetData(data);
}

REGISTER_CONTROLLER(CGrnController, "grn_controller")
