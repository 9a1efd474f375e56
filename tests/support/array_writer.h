// HDF5 and NetCDF files for tests, written by their own libraries.
#pragma once

#include <string>
#include <type_traits>
#include <vector>

#include <catch2/catch.hpp>
#include <hdf5.h>
#include <netcdf.h>

namespace pellucid::test {

template <class T>
hid_t hdf5TypeOf() {
    if constexpr (std::is_same_v<T, float>) return H5T_NATIVE_FLOAT;
    if constexpr (std::is_same_v<T, double>) return H5T_NATIVE_DOUBLE;
    constexpr bool isSigned = std::is_signed_v<T>;
    switch (sizeof(T)) {
    case 1:
        return isSigned ? H5T_NATIVE_INT8 : H5T_NATIVE_UINT8;
    case 2:
        return isSigned ? H5T_NATIVE_INT16 : H5T_NATIVE_UINT16;
    case 4:
        return isSigned ? H5T_NATIVE_INT32 : H5T_NATIVE_UINT32;
    default:
        return isSigned ? H5T_NATIVE_INT64 : H5T_NATIVE_UINT64;
    }
}

class Hdf5Writer {
public:
    explicit Hdf5Writer(const std::string& path, hsize_t userBlock = 0) {
        const hid_t creation = H5Pcreate(H5P_FILE_CREATE);
        H5Pset_userblock(creation, userBlock);
        m_file = H5Fcreate(path.c_str(), H5F_ACC_TRUNC, creation, H5P_DEFAULT);
        H5Pclose(creation);
        REQUIRE(m_file >= 0);
    }
    ~Hdf5Writer() { H5Fclose(m_file); }
    Hdf5Writer(const Hdf5Writer&) = delete;
    Hdf5Writer& operator=(const Hdf5Writer&) = delete;
    hid_t id() const { return m_file; }

    /// How the next array() is stored; the caller adds chunks and filters.
    hid_t how = H5Pcreate(H5P_DATASET_CREATE);

    /// Without `values` nothing is written.
    template <class T>
    void array(const std::string& name, const std::vector<hsize_t>& dims, const std::vector<T>& values,
               hid_t inFile = -1) {
        const hid_t space = H5Screate_simple(static_cast<int>(dims.size()), dims.data(), nullptr);
        const hid_t links = H5Pcreate(H5P_LINK_CREATE);
        H5Pset_create_intermediate_group(links, 1);
        const hid_t type = inFile < 0 ? hdf5TypeOf<T>() : inFile;
        const hid_t data = H5Dcreate2(m_file, name.c_str(), type, space, links, how, H5P_DEFAULT);
        REQUIRE(data >= 0);
        if (!values.empty()) {
            const hid_t memory = H5Tget_class(type) == H5T_ENUM ? type : hdf5TypeOf<T>();
            REQUIRE(H5Dwrite(data, memory, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) >= 0);
        }
        H5Dclose(data);
        H5Pclose(links);
        H5Sclose(space);
        H5Pclose(how);
        how = H5Pcreate(H5P_DATASET_CREATE);
    }
    void text(const std::string& of, const std::string& name, const std::string& value) {
        const hid_t type = H5Tcopy(H5T_C_S1), space = H5Screate(H5S_SCALAR);
        H5Tset_size(type, value.size() + 1);
        attribute(of, name, type, space, value.c_str());
        H5Tclose(type);
    }
    void numbers(const std::string& of, const std::string& name, const std::vector<double>& values) {
        const hsize_t count = values.size();
        attribute(of, name, H5T_NATIVE_DOUBLE, H5Screate_simple(1, &count, nullptr), values.data());
    }

private:
    void attribute(const std::string& of, const std::string& name, hid_t type, hid_t space, const void* value) {
        const hid_t object = H5Oopen(m_file, of.c_str(), H5P_DEFAULT);
        const hid_t made = H5Acreate2(object, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT);
        REQUIRE(H5Awrite(made, type, value) >= 0);
        H5Aclose(made);
        H5Oclose(object);
        H5Sclose(space);
    }
    hid_t m_file = -1;
};

/// `format`: flags of nc_create().
class NetCdfWriter {
public:
    explicit NetCdfWriter(const std::string& path, int format = 0) {
        REQUIRE(nc_create(path.c_str(), NC_CLOBBER | format, &m_file) == NC_NOERR);
    }
    ~NetCdfWriter() { nc_close(m_file); }
    NetCdfWriter(const NetCdfWriter&) = delete;
    NetCdfWriter& operator=(const NetCdfWriter&) = delete;

    void dimension(const std::string& name, std::size_t size) {
        int id = 0;
        REQUIRE(nc_def_dim(m_file, name.c_str(), size, &id) == NC_NOERR);
    }
    void variable(const std::string& name, nc_type type, const std::vector<std::string>& dimensions) {
        std::vector<int> ids;
        for (const std::string& dimension : dimensions) {
            ids.push_back(0);
            REQUIRE(nc_inq_dimid(m_file, dimension.c_str(), &ids.back()) == NC_NOERR);
        }
        int id = 0;
        REQUIRE(nc_def_var(m_file, name.c_str(), type, static_cast<int>(ids.size()), ids.data(), &id) == NC_NOERR);
    }
    void text(const std::string& of, const std::string& name, const std::string& value) {
        REQUIRE(nc_put_att_text(m_file, idOf(of), name.c_str(), value.size(), value.c_str()) == NC_NOERR);
    }
    void number(const std::string& of, const std::string& name, nc_type type, double value) {
        REQUIRE(nc_put_att_double(m_file, idOf(of), name.c_str(), type, 1, &value) == NC_NOERR);
    }
    /// Definitions are over. `dims`: how many values there are along each axis.
    void values(const std::string& of, const std::vector<std::size_t>& dims, const std::vector<double>& values) {
        nc_enddef(m_file);
        const std::vector<std::size_t> first(dims.size(), 0);
        REQUIRE(nc_put_vara_double(m_file, idOf(of), first.data(), dims.data(), values.data()) == NC_NOERR);
    }

private:
    int idOf(const std::string& name) const {
        int id = 0;
        REQUIRE(nc_inq_varid(m_file, name.c_str(), &id) == NC_NOERR);
        return id;
    }
    int m_file = -1;
};

} // namespace pellucid::test
