// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/files/late_function.h"

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavdevice/avdevice.h>
#include <libavformat/avformat.h>
#include <libavutil/display.h>
#include <libavutil/sha.h>
#include <libswscale/swscale.h>
}

/// The functions of FFmpeg that we use. Its libraries, which need a hundred others, are loaded at
/// the first call. Programs link none of them.
namespace gpo::libav {

/// Finds a function in FFmpeg's libraries of the version of the headers. Throws InputError.
void* find(const char* name);

/// The same in its library for cameras.
void* find_in_devices(const char* name);

template <class F>
using Function = LateFunction<F, find>;
template <class F>
using DeviceFunction = LateFunction<F, find_in_devices>;

/// Sets what is called once, before the library for files is loaded.
void before_loading(void (*call)());

inline const Function<decltype(::av_d2q)> av_d2q{"av_d2q"};
inline const Function<decltype(::av_dict_free)> av_dict_free{"av_dict_free"};
inline const Function<decltype(::av_dict_get)> av_dict_get{"av_dict_get"};
inline const Function<decltype(::av_dict_set)> av_dict_set{"av_dict_set"};
inline const Function<decltype(::av_display_matrix_flip)> av_display_matrix_flip{
    "av_display_matrix_flip"};
inline const Function<decltype(::av_display_rotation_get)> av_display_rotation_get{
    "av_display_rotation_get"};
inline const Function<const AVInputFormat*(const char*)> av_find_input_format{
    "av_find_input_format"};
inline const Function<decltype(::av_find_best_stream)> av_find_best_stream{"av_find_best_stream"};
inline const Function<decltype(::av_frame_alloc)> av_frame_alloc{"av_frame_alloc"};
inline const Function<decltype(::av_frame_free)> av_frame_free{"av_frame_free"};
inline const Function<decltype(::av_frame_get_buffer)> av_frame_get_buffer{"av_frame_get_buffer"};
inline const Function<decltype(::av_frame_make_writable)> av_frame_make_writable{
    "av_frame_make_writable"};
inline const Function<decltype(::av_free)> av_free{"av_free"};
inline const Function<decltype(::av_max_alloc)> av_max_alloc{"av_max_alloc"};
inline const Function<decltype(::av_packet_alloc)> av_packet_alloc{"av_packet_alloc"};
inline const Function<decltype(::av_packet_free)> av_packet_free{"av_packet_free"};
inline const Function<decltype(::av_packet_rescale_ts)> av_packet_rescale_ts{
    "av_packet_rescale_ts"};
inline const Function<decltype(::av_packet_unref)> av_packet_unref{"av_packet_unref"};
inline const Function<decltype(::av_read_frame)> av_read_frame{"av_read_frame"};
inline const Function<decltype(::av_seek_frame)> av_seek_frame{"av_seek_frame"};
inline const Function<decltype(::av_sha_alloc)> av_sha_alloc{"av_sha_alloc"};
inline const Function<decltype(::av_sha_final)> av_sha_final{"av_sha_final"};
inline const Function<decltype(::av_sha_init)> av_sha_init{"av_sha_init"};
inline const Function<decltype(::av_sha_update)> av_sha_update{"av_sha_update"};
inline const Function<decltype(::av_strerror)> av_strerror{"av_strerror"};
inline const Function<decltype(::av_write_frame)> av_write_frame{"av_write_frame"};
inline const Function<decltype(::av_write_trailer)> av_write_trailer{"av_write_trailer"};
inline const Function<decltype(::avcodec_alloc_context3)> avcodec_alloc_context3{
    "avcodec_alloc_context3"};
inline const Function<decltype(::avcodec_find_encoder)> avcodec_find_encoder{
    "avcodec_find_encoder"};
inline const Function<decltype(::avcodec_flush_buffers)> avcodec_flush_buffers{
    "avcodec_flush_buffers"};
inline const Function<decltype(::avcodec_free_context)> avcodec_free_context{
    "avcodec_free_context"};
inline const Function<decltype(::avcodec_open2)> avcodec_open2{"avcodec_open2"};
inline const Function<decltype(::avcodec_parameters_from_context)> avcodec_parameters_from_context{
    "avcodec_parameters_from_context"};
inline const Function<decltype(::avcodec_parameters_to_context)> avcodec_parameters_to_context{
    "avcodec_parameters_to_context"};
inline const Function<decltype(::avcodec_receive_frame)> avcodec_receive_frame{
    "avcodec_receive_frame"};
inline const Function<decltype(::avcodec_receive_packet)> avcodec_receive_packet{
    "avcodec_receive_packet"};
inline const Function<decltype(::avcodec_send_frame)> avcodec_send_frame{"avcodec_send_frame"};
inline const Function<decltype(::avcodec_send_packet)> avcodec_send_packet{"avcodec_send_packet"};
inline const DeviceFunction<decltype(::avdevice_register_all)> avdevice_register_all{
    "avdevice_register_all"};
inline const Function<decltype(::avformat_alloc_context)> avformat_alloc_context{
    "avformat_alloc_context"};
inline const Function<decltype(::avformat_alloc_output_context2)> avformat_alloc_output_context2{
    "avformat_alloc_output_context2"};
inline const Function<decltype(::avformat_close_input)> avformat_close_input{
    "avformat_close_input"};
inline const Function<decltype(::avformat_find_stream_info)> avformat_find_stream_info{
    "avformat_find_stream_info"};
inline const Function<decltype(::avformat_free_context)> avformat_free_context{
    "avformat_free_context"};
inline const Function<decltype(::avformat_index_get_entries_count)>
    avformat_index_get_entries_count{"avformat_index_get_entries_count"};
inline const Function<const AVIndexEntry*(AVStream*, int)> avformat_index_get_entry{
    "avformat_index_get_entry"};
inline const Function<decltype(::avformat_new_stream)> avformat_new_stream{"avformat_new_stream"};
inline const Function<decltype(::avformat_open_input)> avformat_open_input{"avformat_open_input"};
inline const Function<int(AVFormatContext*, AVDictionary**)> avformat_write_header{
    "avformat_write_header"};
inline const Function<decltype(::avio_closep)> avio_closep{"avio_closep"};
inline const Function<decltype(::avio_flush)> avio_flush{"avio_flush"};
inline const Function<decltype(::avio_seek)> avio_seek{"avio_seek"};
inline const Function<decltype(::avio_size)> avio_size{"avio_size"};
inline const Function<decltype(::avio_open)> avio_open{"avio_open"};
inline const Function<decltype(::sws_freeContext)> sws_freeContext{"sws_freeContext"};
inline const Function<decltype(::sws_getCachedContext)> sws_getCachedContext{
    "sws_getCachedContext"};
inline const Function<decltype(::sws_getCoefficients)> sws_getCoefficients{"sws_getCoefficients"};
inline const Function<decltype(::sws_scale)> sws_scale{"sws_scale"};
inline const Function<decltype(::sws_setColorspaceDetails)> sws_setColorspaceDetails{
    "sws_setColorspaceDetails"};
#if LIBAVFORMAT_VERSION_INT < AV_VERSION_INT(60, 15, 100)  // Debian 12 has 59, Debian 13 has 61
inline const Function<decltype(::av_stream_get_side_data)> av_stream_get_side_data{
    "av_stream_get_side_data"};
#else
inline const Function<decltype(::av_packet_side_data_get)> av_packet_side_data_get{
    "av_packet_side_data_get"};
#endif

}  // namespace gpo::libav
