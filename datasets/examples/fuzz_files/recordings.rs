//! Small recordings in the formats of others, which are damaged.

use crate::ulog_file::Log;

/// Takes of Motive: markers and bodies, with an occlusion.
pub fn motive() -> Vec<Vec<u8>> {
    let head = "Format Version,1.23,Take Name,a,Capture Frame Rate,120,Export Frame Rate,120,Total Exported Frames,30,\
                Rotation Type,Quaternion,Length Units,Meters,Coordinate Space,Global\r\n\r\n";
    let labels = ",Type,Rigid Body,Rigid Body,Rigid Body,Marker,Marker,Marker\r\n,Name,Tip,Tip,Tip,Tip:Marker1,Tip:Marker1,\
                  Tip:Marker1\r\n,ID,\"1\",\"1\",\"1\",\"2\",\"2\",\"2\"\r\n,,Rotation,Position,Position,Position,Position,\
                  Position\r\nFrame,Time (Seconds),W,X,Y,X,Y,Z\r\n";
    let row = |k: usize| {
        let marker = if k == 7 { ",,".to_string() } else { format!("{},{},{}", k, 0.5 * k as f64, -0.25 * k as f64) };
        format!("{k},{:.3},1,{},2,{marker}\r\n", k as f64 / 120.0, 0.125 * k as f64)
    };
    let rows: String = (0..30).map(row).collect();
    vec![format!("{head}{labels}{rows}").into_bytes(), format!("{labels}{rows}").into_bytes()]
}

/// Two sections of Nexus at two rates.
pub fn vicon() -> Vec<Vec<u8>> {
    let mut text = String::from("Devices\n1000\n,,Plate,\nFrame,Sub Frame,Fx,Fy\n,,N,N\n");
    (0..40).for_each(|k| text += &format!("{},{},{},1\n", 1 + k / 10, k % 10, k));
    text += "\nTrajectories\n100\n,,arm:a,,,arm:b,,\nFrame,Sub Frame,X,Y,Z,X,Y,Z\n,,mm,mm,mm,mm,mm,mm\n";
    (0..20).for_each(|k| text += &format!("{},0,{k},1,2,3,{k},\n", k + 1));
    vec![text.into_bytes()]
}

/// Markers, with tabs and with commas.
pub fn trc() -> Vec<Vec<u8>> {
    let mut text = String::from(
        "PathFileType\t4\t(X/Y/Z)\ta.trc\nDataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\n100\t100\t20\t2\tmm\n\
         Frame#\tTime\ta\t\t\tb\t\t\n\t\tX1\tY1\tZ1\tX2\tY2\tZ2\n\n",
    );
    (0..20).for_each(|k| text += &format!("{}\t{:.2}\t{k}\t1\t2\t3\t\t{k}\n", k + 1, 0.01 * f64::from(k)));
    vec![text.replace('\t', ",").into_bytes(), text.into_bytes()]
}

/// Logs of PX4.
pub fn ulog() -> Vec<Vec<u8>> {
    vec![Log::of(60).0, Log::of(3).0]
}

/// Recordings of ROS 2, in chunks that are compressed and in others.
#[cfg(feature = "mcap")]
pub fn mcap() -> Vec<Vec<u8>> {
    use mcap::{Compression, WriteOptions};
    let options = [Some(Compression::Lz4), None].map(|of| WriteOptions::new().compression(of).chunk_size(Some(300)));
    let written = |options: WriteOptions| -> mcap::McapResult<Vec<u8>> {
        let mut bytes = std::io::Cursor::new(Vec::new());
        let mut writer = options.create(&mut bytes)?;
        let schema = b"std_msgs/Header header\nstring[] name\nfloat64[] position\n====\nMSG: std_msgs/Header\n\
                       builtin_interfaces/Time stamp\nstring frame_id\n====\nMSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n";
        let schema = writer.add_schema("sensor_msgs/msg/JointState", "ros2msg", schema)?;
        let channel_id = writer.add_channel(schema, "/joints", "cdr", &Default::default())?;
        for k in 0u32..20 {
            let mut data = vec![0, 1, 0, 0];
            [k, 500, 2].iter().for_each(|v| data.extend(v.to_le_bytes()));
            data.extend(b"a\0\0\0");
            data.extend(1u32.to_le_bytes());
            data.extend(2u32.to_le_bytes());
            data.extend(b"q\0\0\0");
            data.extend(1u32.to_le_bytes());
            data.extend([0; 4]);
            data.extend((0.5 * f64::from(k)).to_le_bytes());
            let (log_time, publish_time) = (u64::from(k) * 10_000_000, 0);
            let header = mcap::records::MessageHeader { channel_id, sequence: k, log_time, publish_time };
            writer.write_to_known_channel(&header, &data)?;
        }
        writer.finish()?;
        drop(writer);
        Ok(bytes.into_inner())
    };
    options.into_iter().filter_map(|options| written(options).ok()).collect()
}

/// Without the feature there are none.
#[cfg(not(feature = "mcap"))]
pub fn mcap() -> Vec<Vec<u8>> {
    vec![b"\x89MCAP0\r\n".to_vec()]
}
