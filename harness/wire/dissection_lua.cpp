// SPDX-License-Identifier: Apache-2.0
#include "harness/wire/dissection_lua.hpp"

namespace armjig::lua {

const std::string_view kFields = R"lua(
local is_new, protocol = pcall(Proto, device, title)
if not is_new then return end -- it was loaded from another folder
local direction_of = Field.new("frame.packet_flags_direction")
local interface_of = Field.new("frame.interface_id")
local all, field_of, flags_of = {}, {}, {}
local function register(field)
  all[#all + 1] = field
  return field
end
local message_field = register(ProtoField.string(device .. ".message", "message"))
local from_device_field = register(ProtoField.bool(device .. ".from_device", "from the device"))
local noise_field = register(ProtoField.bytes(device .. ".noise", "noise"))
local rest_field = register(ProtoField.bytes(device .. ".rest", "a part of a message"))
local fault_field = register(ProtoField.string(device .. ".fault", "fault"))
local noise_expert = ProtoExpert.new(device .. ".noise.expert", "no message",
                                     expert.group.MALFORMED, expert.severity.WARN)
local value_expert = ProtoExpert.new(device .. ".value.expert", "a value without a name",
                                     expert.group.UNDECODED, expert.severity.NOTE)
protocol.experts = {noise_expert, value_expert}

-- Values have their names in filters, too, unless a field has other names in another message.
local function is_same(one, other)
  for value, name in pairs(one) do
    if other[value] ~= name then return false end
  end
  return true
end
for _, kind in ipairs(messages) do
  for _, field in ipairs(kind.fields) do
    local known = field_of[field.name] or {type = field.type, names = field.names}
    field_of[field.name] = known
    assert(known.type == field.type, field.name .. " has two types")
    if known.names and not (field.names and is_same(known.names, field.names)) then
      known.names = nil
    end
  end
end
-- A field that has the name of what each message has is only that.
local is_taken = {message = true, from_device = true, noise = true, rest = true, fault = true}
local make = {signed = ProtoField.int32, unsigned = ProtoField.uint32}
for _, kind in ipairs(messages) do
  for _, field in ipairs(kind.fields) do
    local name = device .. "." .. field.name
    local known = field_of[field.name]
    if is_taken[field.name] then
      known.field = nil
    elseif not known.field then
      known.field = register(known.type == "float" and ProtoField.float(name, field.name) or
                             make[known.type](name, field.name, base.DEC, known.names))
    end
    field.shown, field.is_named = known.field, known.names ~= nil
    for _, flag in ipairs(field.bits or {}) do
      local flag_name = name .. "." .. flag.name
      flags_of[flag_name] = flags_of[flag_name] or register(ProtoField.bool(flag_name, flag.name))
      flag.shown = flags_of[flag_name]
    end
  end
end
protocol.fields = all

local function number_of(field, bytes)
  local value = 0
  for i = 1, field.width do
    value = value * 256 + bytes:byte(field.little and field.width - i + 1 or i)
  end
  if field.type == "signed" and value >= 2 ^ (8 * field.width - 1) then
    value = value - 2 ^ (8 * field.width)
  end
  return value
end

-- Where the fields of a message are, and what they are: a list of field, offset, width and, of text,
-- value.
local function places_of(kind, bytes)
  local places = {}
  for i, field in ipairs(kind.fields) do
    places[i] = {field = field, offset = field.offset, width = field.width}
  end
  return places
end
)lua";

const std::string_view kCutSizes = R"lua(
local kind_of = {}
for _, kind in ipairs(messages) do
  kind_of[kind.from_device and "from" or "to"] = kind
  kind.size = 0
  for _, field in ipairs(kind.fields) do
    kind.size = math.max(kind.size, field.offset + field.width)
  end
  local first = kind.fields[1]
  kind.mark = first.literal and string.char(table.unpack(first.literal))
end

-- What begins at `at`: the size of a message or, with a fault, of what is none; nothing if more
-- bytes must come to tell.
local function judge(kind, bytes, at)
  for number, field in ipairs(kind.fields) do
    if field.literal then
      for i = 1, field.width do
        local byte = bytes:byte(at + field.offset + i - 1)
        if not byte then return nil end
        if byte ~= field.literal[i] then
          local is_begin = number == 1 or byte == kind.fields[1].literal[1]
          return 1, is_begin and "no start of a message" or
                 string.format("%s: 0x%02X where 0x%02X is due", field.name, byte,
                               field.literal[i]), is_begin
        end
      end
    end
  end
  if #bytes < at + kind.size - 1 then return nil end
  local fault = check(bytes:sub(at, at + kind.size - 1))
  if fault then return 1, fault end
  return kind.size
end

-- Messages, and what is none between them, of `bytes`; and where the rest begins.
local function cut(state, bytes, way)
  local kind, found, at = kind_of[way], {}, 1
  while at <= #bytes do
    local size, fault, is_weak = judge(kind, bytes, at)
    if not size then break end
    local last = found[#found]
    if fault and last and last.fault then
      last.size = last.size + size
      if last.is_weak and not is_weak then last.fault, last.is_weak = fault, false end
    else
      found[#found + 1] = {at = at, size = size, name = fault and "noise" or kind.name,
                           kind = not fault and kind or nil, fault = fault, is_weak = is_weak}
    end
    at = at + size
  end
  return found, at
end
)lua";

const std::string_view kCutLines = R"lua(
local kind_of = {to = {}, from = {}}
for _, kind in ipairs(messages) do kind_of[kind.from_device and "from" or "to"][kind.name] = kind end

local function pieces_of(text)
  local pieces = {}
  for piece in (text .. ":"):gmatch("([^:]*):") do pieces[#pieces + 1] = piece end
  return pieces
end

-- The fault of an argument.
local function judge_argument(kind, field, text)
  if field.names then
    for _, name in pairs(field.names) do
      if name == text then return nil end
    end
    return kind.bad_word
  end
  if kind.from_device then -- a byte, and nothing else
    local digits = text:match("^%d+")
    if digits and tonumber(digits) > 255 then return words.too_large end
    return (digits ~= text or text:match("^0.")) and words.not_a_number or nil
  end
  local sign, digits = text:match("^%s*([+-]?)(%d+)")
  if not digits then return words.not_a_number end
  return tonumber(digits) > (sign == "-" and 2 ^ 31 or 2 ^ 31 - 1) and words.too_large or nil
end

-- The kind of a line without its LF, and what is wrong with it.
local function read_line(line, way)
  local arguments
  if way == "from" then
    if line == "" then return nil, words.empty end
    if line:sub(-1) ~= "\r" then return nil, words.no_return end
    line = line:sub(1, -2)
  else
    line = line:match("^%s*(.-)%s*$")
  end
  if line == "" then return nil, words.empty end
  local name, colon, rest = line:match("^([^:]*)(:?)(.*)$")
  if way == "to" then name = name:match("^%s*(.-)%s*$") end
  local kind = kind_of[way][name]
  if not kind then return nil, words.unknown_word end
  if colon == "" then
    arguments = {}
  elseif way == "from" then
    arguments = {rest}
  else
    arguments = pieces_of(rest)
    if arguments[#arguments] == "" then arguments[#arguments] = nil end
  end
  if #arguments ~= #kind.fields - 1 then return nil, words.argument_count end
  for i, argument in ipairs(arguments) do
    local fault = judge_argument(kind, kind.fields[i + 1], argument)
    if fault then return nil, fault end
  end
  return kind
end

-- Lines of `bytes`, and where the rest begins. One that has no end yet is cut at `patience`.
local function cut(state, bytes, way, patience)
  local found, at = {}, 1
  while at <= #bytes do
    local feed = bytes:find("\n", at, true)
    local size = (feed or #bytes + 1) - at
    if size > longest and (feed or size > (patience or longest)) then
      found[#found + 1] = {at = at, size = longest, name = "line", fault = words.too_long}
      state.is_long = true
      at = at + longest
    elseif not feed then
      break
    else
      local kind, fault = nil, words.too_long
      if not state.is_long then kind, fault = read_line(bytes:sub(at, feed - 1), way) end
      state.is_long = false
      found[#found + 1] = {at = at, size = size + 1, name = kind and kind.name or "line",
                           kind = kind, fault = fault}
      at = feed + 1
    end
  end
  return found, at
end

function places_of(kind, bytes)
  local places, offset = {}, 0
  local pieces = pieces_of(bytes:match("^[^\r\n]*"))
  for i, field in ipairs(kind.fields) do
    local text, value = pieces[i] or "", -1
    if field.names then
      for number, name in pairs(field.names) do
        if name == text then value = number end
      end
    else
      value = tonumber((text:gsub("^[ \t\v\f\r+]*", ""):match("^-?%d+"))) or -1
    end
    places[i] = {field = field, offset = offset, width = #text, value = value}
    offset = offset + #text + 1
  end
  return places
end
)lua";

const std::string_view kCutTransactions = R"lua(
for _, kind in ipairs(messages) do
  kind.most = {}
  for _, field in ipairs(kind.fields) do
    local list, number = field.name:match("^(.*)%.(%d+)$")
    if list and kind.begin then
      field.list, field.number = list, tonumber(number)
      kind.most[list] = math.max(kind.most[list] or 0, field.number + 1)
    end
    field.counts = kind.begin and field.name:match("^(.*)%.count$")
  end
end

-- Also how many bytes the message has; nothing but a fault and where it is if it is none.
function places_of(kind, bytes)
  local places, counts, offset = {}, {}, 0
  for _, field in ipairs(kind.fields) do
    if not field.list or field.number < (counts[field.list] or 0) then
      if not kind.begin then offset = field.offset end
      if #bytes < offset + field.width then return nil, kind.cut_short, #bytes end
      if field.counts then
        counts[field.counts] = bytes:byte(offset + 1)
        if counts[field.counts] > (kind.most[field.counts] or 0) then
          return nil, kind.too_many, offset
        end
      end
      places[#places + 1] = {field = field, offset = offset, width = field.width}
      offset = offset + field.width
    end
  end
  return places, offset
end

-- The first kind that fits, the bytes that it takes, and the fault of what follows them.
local function read_transaction(state, bytes)
  local first = bytes:byte(1)
  local address, is_read = math.floor(first / 2), first % 2 == 1
  local key = bytes:byte(2)
  if is_read then key = state[address] or first_choice end
  for _, kind in ipairs(messages) do
    if kind.from_device == is_read and (not kind.address or kind.address == address) and
       (not kind.key or kind.key == key) and (not kind.is_alone or #bytes == #kind.fields) then
      local places, size, where = places_of(kind, bytes)
      local fault = kind.surplus
      if places and kind.begin then
        fault = check(bytes:sub(1, size), kind.begin)
        if fault then places, size, where = nil, fault, size - 1 else fault = kind.surplus end
      end
      if places then
        if kind.is_choice then state[address] = key end
        return kind, size, fault
      end
      if size then return nil, 0, string.format(size, where - (kind.begin or 0)) end
    end
  end
  return nil, 0, "of no kind"
end

local function cut(state, bytes)
  local found = {}
  local kind, size, fault = read_transaction(state, bytes)
  if size > 0 then found[1] = {at = 1, size = size, name = kind.name, kind = kind} end
  if size < #bytes then
    found[#found + 1] = {at = size + 1, size = #bytes - size, name = "noise", fault = fault}
  end
  return found, #bytes + 1
end
)lua";

const std::string_view kShow = R"lua(
local states, seen, is_ours = {}, {}, {}
function protocol.init() states, seen, is_ours = {}, {}, {} end

local function show_field(tree, place, range)
  local field, value = place.field, place.value
  if not value then
    value = number_of(field, range:bytes():raw())
  end
  local item
  if field.type == "float" then
    item = tree:add_le(field.shown, range)
  else
    item = tree:add(field.shown, range, value)
  end
  local name = field.names and field.names[value]
  if name and not field.is_named then item:append_text(" (" .. name .. ")") end
  if field.names and not name and not place.value then item:add_proto_expert_info(value_expert) end
  if field.unit then item:append_text(" " .. field.unit) end
  for _, flag in ipairs(field.bits or {}) do
    local is_set = math.floor(value / 2 ^ flag.bit) % 2 == 1
    item:add(flag.shown, range, is_set)
  end
  return name, field.type == "float" and string.format("%g", range:le_float()) or value
end

local function begin_item(tree, range, way, name, text)
  local item = tree:add(protocol, range, title .. ", " .. text)
  item:add(message_field, range, name):set_generated()
  item:add(from_device_field, range, way == "from"):set_generated()
  return item
end

local most_numbers = 5 -- of fields in a message whose numbers the line of the packet shows
local function show_message(tree, way, kind, range)
  local item = begin_item(tree, range, way, kind.name, kind.name)
  local text = kind.name
  for i, place in ipairs((places_of(kind, range:bytes():raw()))) do
    -- An empty piece is shown where the message begins.
    local part = place.width > 0 and range:range(place.offset, place.width) or range
    local name, value
    if place.field.shown then name, value = show_field(item, place, part) end
    -- The first field says what the message is, or to whom.
    if not name and i > 1 and #kind.fields <= most_numbers then name = value end
    if name and name ~= kind.name then text = text .. " " .. place.field.name .. "=" .. name end
  end
  return text
end

local function show_noise(tree, way, one, range)
  local item = begin_item(tree, range, way, one.name, one.name)
  item:add(noise_field, range)
  item:add(fault_field, range, one.fault):set_generated()
  item:add_proto_expert_info(noise_expert, one.fault)
  return one.name .. ": " .. one.fault
end

-- Shows what was found in `whole`, and the rest of it.
local function show(packet, tree, way, whole, found, rest)
  local texts = {}
  for _, one in ipairs(found) do
    local range = whole:range(one.at - 1, one.size)
    texts[#texts + 1] = one.kind and show_message(tree, way, one.kind, range) or
                        show_noise(tree, way, one, range)
  end
  if rest <= whole:len() then
    local range = whole:range(rest - 1)
    begin_item(tree, range, way, "rest", "a part of a message"):add(rest_field, range)
    texts[#texts + 1] = "a part of a message"
  end
  packet.cols.protocol = device
  packet.cols.info = table.concat(texts, "; ")
end

-- A packet of a lane, in which messages may go on from one packet to the next. What is known of it
-- is found when it is seen first, in order; looked at again, it is the same.
local function take(buffer, packet, lane, way)
  local known = seen[packet.number]
  if not known then
    local state = states[lane] or {rest = ""}
    states[lane] = state
    local before = state.rest
    local bytes = before .. buffer:raw()
    local found, rest = cut(state, bytes, way)
    known = {before = before, found = found, rest = rest}
    state.rest = bytes:sub(rest)
    seen[packet.number] = known
  end
  return known
end

local function show_taken(buffer, packet, tree, way, known)
  local whole = buffer
  if #known.before > 0 then
    whole = ByteArray.new(known.before .. buffer:raw(), true):tvb("with what came before")
  end
  show(packet, tree, way, whole, known.found, known.rest)
end

local function last_of(field)
  local values = {field()}
  local last = values[#values]
  return last and last.value
end
local function number_text(field) return tostring(last_of(field)) end
local function interface_text() return number_text(interface_of) end
local hooks = {} -- each takes what is its own, and answers whether it did
)lua";

const std::string_view kTcp = R"lua(
-- TCP puts segments in order. What is no whole message is asked for again with more.
local most_held = 65536
local tcp_port_of = Field.new("tcp.dstport")
hooks[#hooks + 1] = function(buffer, packet, tree)
  local port = last_of(tcp_port_of)
  if not port then return false end
  local way = packet.dst_port == packet.match_uint and "to" or "from"
  local found, rest = cut({}, buffer:raw(), way, most_held)
  if rest <= buffer:len() and packet.can_desegment > 0 then
    packet.desegment_offset = rest - 1
    packet.desegment_len = DESEGMENT_ONE_MORE_SEGMENT
    if #found == 0 then return true end
    rest = buffer:len() + 1
  end
  show(packet, tree, way, buffer, found, rest)
  return true
end
DissectorTable.get("tcp.port"):add(tcp_port, protocol)
)lua";

const std::string_view kUsb = R"lua(
-- Bulk transfers of the board, known by its numbers if the recording has them, else by a message.
local usb = {}
for _, name in ipairs({"bus_id", "device_address", "endpoint_address.direction", "transfer_type"}) do
  usb[name] = Field.new("usb." .. name)
end
local bulk = 3
local function take_usb(buffer, packet, tree, is_known)
  if last_of(usb.transfer_type) ~= bulk or buffer:len() == 0 then return false end
  local place = number_text(usb.bus_id) .. "." .. number_text(usb.device_address)
  local way = last_of(usb["endpoint_address.direction"]) == 1 and "from" or "to"
  local lane = "usb" .. interface_text() .. "." .. place .. way
  if is_known then is_ours[place] = true end
  if not seen[packet.number] and not is_ours[place] then
    if packet.visited then return false end
    local mark = kind_of[way].mark
    local bytes = ((states[lane] or {}).rest or "") .. buffer:raw()
    if not bytes:find(mark, 1, true) then
      states[lane] = {rest = bytes:sub(-#mark)}
      return false
    end
    local known = take(buffer, packet, lane, way)
    for _, one in ipairs(known.found) do
      if one.kind then is_ours[place] = true end
    end
    if not is_ours[place] then
      seen[packet.number] = nil
      return false
    end
  end
  show_taken(buffer, packet, tree, way, take(buffer, packet, lane, way))
  return true
end
hooks[#hooks + 1] = function(buffer, packet, tree)
  return last_of(usb.bus_id) ~= nil and take_usb(buffer, packet, tree, true)
end
protocol:register_heuristic("usb.bulk", function(buffer, packet, tree)
  return take_usb(buffer, packet, tree, false)
end)
DissectorTable.get("usb.product"):add(usb_product, protocol)
)lua";

const std::string_view kBus = R"lua(
-- I2C as Linux has it: shown by Wireshark's own dissector first, whose payload no other can take
-- without the user's choice. What happens beside transfers is its own.
protocol.prefs.i2c = Pref.bool("I2C transfers are of " .. title, true,
                               "Turn it off for recordings of other buses")
local packets = DissectorTable.get("wtap_encap")
local i2c = packets:get_dissector(wtap.I2C_LINUX)
local i2c_event_of, i2c_bus_of = Field.new("i2c.event"), Field.new("i2c.bus")
local interface_name_of = Field.new("frame.interface_name")

-- What was acknowledged armjig writes in JSON before the transfer, with the name of its interface.
local json_begin = "\0\12\0\4json\0\0\0\0{\"armjig.of\":\""
local told, acks_at = {}, {}
local acks = Proto(device .. "_acks", title .. ", acknowledgements")
function acks.init() told, acks_at = {}, {} end
function acks.dissector(buffer, packet)
  if packet.visited or buffer:len() < #json_begin then return end
  if buffer:raw(0, #json_begin) ~= json_begin then return end
  local interface, more = buffer:raw(#json_begin):match('^([^"]*)"(.*)')
  if interface then told[interface] = more:match('"ack":"([AN]*)"') end
end
register_postdissector(acks)

local nack_expert = ProtoExpert.new(device .. ".nack.expert", "not acknowledged",
                                    expert.group.RESPONSE_CODE, expert.severity.NOTE)
acks.experts = {nack_expert}

-- Of a transfer what was acknowledged; all of it, if nobody says.
local function acknowledged(buffer, packet, tree, way)
  local interface = last_of(interface_name_of)
  if not packet.visited and interface then
    acks_at[packet.number], told[interface] = told[interface], nil
  end
  local letters = acks_at[packet.number]
  if not letters then return buffer end
  local count = #letters:match("^A*")
  if way == "from" and count > 0 or count >= buffer:len() then return buffer end
  tree:add_proto_expert_info(nack_expert, count == 0 and "nobody acknowledged the address" or
                             string.format("byte %d was not acknowledged", count - 1))
  return count > 0 and buffer:range(0, count):tvb() or nil
end

hooks[#hooks + 1] = function(buffer, packet, tree)
  if i2c then i2c:call(buffer, packet, tree) end
  if i2c_event_of() or not protocol.prefs.i2c or buffer:len() == 0 then return true end
  local lane = "i2c" .. interface_text() .. "." .. number_text(i2c_bus_of)
  local way = buffer:raw(0, 1):byte() % 2 == 1 and "from" or "to"
  local taken = acknowledged(buffer, packet, tree, way)
  if taken then show_taken(taken, packet, tree, way, take(taken, packet, lane, way)) end
  return true
end
packets:add(wtap.I2C_LINUX, protocol)
)lua";

const std::string_view kOwn = R"lua(
function protocol.dissector(buffer, packet, tree)
  if buffer:len() == 0 then return 0 end
  for _, hook in ipairs(hooks) do
    if hook(buffer, packet, tree) then return buffer:len() end
  end
  local flow = direction_of()
  local way = flow and flow.value == 1 and "from" or "to"
  local lane = table.concat({interface_text(), packet.src_port + packet.dst_port, way}, ".")
  show_taken(buffer, packet, tree, way, take(buffer, packet, lane, way))
  return buffer:len()
end
)lua";

}  // namespace armjig::lua
